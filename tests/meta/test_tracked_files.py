"""The repository speaks of itself and not of the machine it was written on."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

# A path of somebody's machine: it starts at the root, so no name and no other slash is before it.
MACHINE_PATH = re.compile(
    r"(?<![\w./~$})>-])(?:/(?:home|root|Users|work|workspace)/\w|[A-Z]:\\Users\\)"
)


def test_no_file_names_a_path_of_a_machine(repository: Path, tracked_files: list[Path]) -> None:
    assert tracked_files
    found = [
        f"{file.relative_to(repository)}:{number}: {line.strip()[:100]}"
        for file in tracked_files
        if b"\0" not in (content := file.read_bytes())
        for number, line in enumerate(content.decode(errors="replace").splitlines(), start=1)
        if MACHINE_PATH.search(line)
    ]
    assert not found


@pytest.mark.parametrize("folder", ["home", "root", "Users", "work"])
def test_a_path_of_a_machine_is_found(folder: str) -> None:
    assert MACHINE_PATH.search(f"open('/{folder}/someone/data.csv')")
    assert MACHINE_PATH.search(f"/{folder}/someone")


@pytest.mark.parametrize("harmless", ["https://example.org/home/page", "../root/file", "a/work/b"])
def test_other_paths_are_left_alone(harmless: str) -> None:
    assert not MACHINE_PATH.search(harmless)


def test_list_of_core_sources_is_complete(repository: Path) -> None:
    core = repository / "core"
    listed = (core / "SOURCES").read_text().split()
    present = [str(file.relative_to(core)) for file in (core / "src").rglob("*.c")]
    assert listed == sorted(present)

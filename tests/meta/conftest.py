"""What the checks of the repository itself look at."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGE = REPOSITORY / "src" / "hyst"


@pytest.fixture(scope="session")
def repository() -> Path:
    return REPOSITORY


@pytest.fixture(scope="session")
def tracked_files() -> list[Path]:
    """Every file git tracks, as it is in the working tree now."""
    if not (REPOSITORY / ".git").exists():
        pytest.skip("not a git checkout, so there is no list of tracked files")
    listing = subprocess.run(
        ["git", "ls-files", "-z"], cwd=REPOSITORY, check=True, capture_output=True, text=True
    ).stdout
    return [REPOSITORY / name for name in listing.split("\0") if (REPOSITORY / name).is_file()]


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that asks for ``source_file`` once for each file of the package."""
    if "source_file" in metafunc.fixturenames:
        files = sorted(PACKAGE.rglob("*.py"))
        names = [str(file.relative_to(PACKAGE)) for file in files]
        metafunc.parametrize("source_file", files, ids=names)


@pytest.fixture
def module_name(source_file: Path) -> str:
    """The name under which ``source_file`` is imported."""
    parts = source_file.relative_to(PACKAGE.parent).with_suffix("").parts
    if parts[-1] == "__main__":
        pytest.skip("importing a __main__ runs it")
    return ".".join(part for part in parts if part != "__init__")

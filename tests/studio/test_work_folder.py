"""Nothing is read and nothing is written beyond the folder."""

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

import hyst
from hyst.studio.work import folder as module
from hyst.studio.work.folder import WorkFolder


@pytest.fixture
def folder(tmp_path: Path) -> WorkFolder:
    (tmp_path / "work").mkdir()
    (tmp_path / "secret.csv").write_text("1,2\n")
    return WorkFolder.at(tmp_path / "work")


async def pieces(*content: bytes) -> AsyncIterator[bytes]:
    for each in content:
        yield each


@pytest.mark.parametrize(
    "name", ["../secret.csv", "/etc/passwd", "a/../../secret.csv", ".", "", "a\0b"]
)
def test_a_way_out_is_refused(folder: WorkFolder, name: str) -> None:
    with pytest.raises(hyst.InputError):
        folder.readable(name)


def test_a_link_out_is_refused_and_not_listed(folder: WorkFolder) -> None:
    (folder.root / "link.csv").symlink_to(folder.root.parent / "secret.csv")
    (folder.root / "way").symlink_to(folder.root.parent)
    assert folder.files() == ()
    for name in ("link.csv", "way/secret.csv"):
        with pytest.raises(hyst.InputError, match="does not lie in"):
            folder.readable(name)


def test_data_files_are_listed_but_hidden_ones_others_and_sessions_are_not(
    folder: WorkFolder,
) -> None:
    for name in ("b.csv", "a.mat", "notes.pdf", "in/c.txt", ".h/d.csv", "s/commands.sh", "s/e.csv"):
        path = folder.root / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("1\n")
    assert folder.files() == ("a.mat", "b.csv", "in/c.txt")


def test_a_file_too_large_is_refused_before_it_is_read(
    folder: WorkFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    with (folder.root / "huge.csv").open("wb") as file:
        file.truncate(2_000_000_000)  # sparse: it takes no room
    with pytest.raises(hyst.InputError, match=r"huge.csv has 2.00 GB.*--in-file"):
        folder.readable("huge.csv")
    monkeypatch.setattr(module, "MOST_BYTES", 5)
    with pytest.raises(hyst.InputError, match="at most"):
        asyncio.run(folder.keep("large.csv", pieces(b"1234", b"56")))
    assert [each.name for each in folder.root.iterdir()] == ["huge.csv"]


def test_what_is_dropped_lies_in_the_folder_under_its_name(folder: WorkFolder) -> None:
    kept = asyncio.run(folder.keep("C:\\data\\loop.csv", pieces(b"1,", b"2\n")))
    assert kept == "loop.csv"
    assert (folder.root / "loop.csv").read_bytes() == b"1,2\n"


def test_nothing_is_overwritten_and_the_same_file_is_kept_once(folder: WorkFolder) -> None:
    names = [
        asyncio.run(folder.keep("a.csv", pieces(content))) for content in (b"1\n", b"2\n", b"1\n")
    ]
    assert names == ["a.csv", "a-2.csv", "a.csv"]


@pytest.mark.parametrize("name", ["", "..", ".hidden", "a" * 200, "x/"])
def test_names_that_are_none_are_refused(folder: WorkFolder, name: str) -> None:
    with pytest.raises(hyst.InputError, match="no name for a file"):
        asyncio.run(folder.keep(name, pieces(b"1\n")))


def test_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(hyst.InputError, match="no folder"):
        WorkFolder.at(tmp_path / "none")

"""The session behind the page: whatever a file holds, it ends in a sentence."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from studio_browser import write_loop

from hyst.studio.session import StudioSession
from hyst.studio.work.folder import WorkFolder

ROWS = "".join(f"{k / 100},{np.sin(k / 9):.5f},{np.sin(k / 9 - 0.3):.5f}\n" for k in range(200))
HEAD = "time [s],drive [V],position [um]\n"
FILES: dict[str, bytes] = {
    "empty.csv": b"",
    "words.csv": b"no,numbers\nat,all\n",
    "picture.csv": b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 4,
    "broken.mat": b"MATLAB 5.0 MAT-file" + bytes(200),
    "broken.npz": b"PK\x03\x04" + bytes(50),
    "broken.parquet": b"PAR1" + bytes(50),
    "two.csv": (HEAD + ROWS + "\n" + HEAD + ROWS).encode(),
    "code.csv": (HEAD + ROWS.replace(",0.00000,", ",9.91e37,", 1)).encode(),
    "still.csv": (HEAD + "".join(f"{k},1,1\n" for k in range(99))).encode(),
    "short.csv": (HEAD + "0,0,0\n1,1,1\n").encode(),
    "back.csv": (HEAD + "0,0,0\n2,1,1\n1,2,2\n3,1,1\n" * 9).encode(),
    "one.csv": b"drive\n1\n2\n3\n",
}


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[StudioSession]:
    folder = tmp_path_factory.mktemp("work")
    for name, content in FILES.items():
        (folder / name).write_bytes(content)
    write_loop(folder / "loop.csv", 2000)
    u = np.sin(np.arange(2000) / 50.0)
    table = np.column_stack([np.arange(2000) / 1e3, u, u**2])
    np.savetxt(folder / "square.csv", table, "%.6g", ",", header="time [s],u,y", comments="")
    made = StudioSession(WorkFolder.at(folder))
    yield made
    made.stop()


def run(session: StudioSession, work: Callable[[], Any]) -> None:
    for each in (session.quick, session.long):
        each._turn = None  # of the loop of another test
    asyncio.run(work())


@pytest.mark.parametrize("name", [*FILES, "none.csv", "../elsewhere.csv"])
def test_what_cannot_be_used_ends_in_a_sentence(session: StudioSession, name: str) -> None:
    run(session, lambda: session.choose_file(name))
    said = session.said.get("file") or session.said.get("record") or ""
    assert len(said.split()) >= 4
    assert "itself failed" not in said
    assert str(session.folder.root) + "/" not in said
    assert session.measured is None
    assert session.busy == set()


def test_of_two_tables_one_can_be_chosen(session: StudioSession) -> None:
    async def work() -> None:
        await session.choose_file("two.csv")
        assert "“Number of the table”" in session.said["file"]
        await session.choose_file("two.csv", 2)

    run(session, work)
    assert session.measured is not None
    assert session.measured.samples == 200
    assert session.session().commands()[0] == "hyst columns records/two.csv --table 2"


def test_a_file_after_one_that_cannot_be_used_is_read(session: StudioSession) -> None:
    run(session, lambda: session.choose_file("loop.csv"))
    assert session.said == {}
    assert session.measured is not None
    assert session.measured.samples == 2000
    assert session.measured.input_label == "drive [V]"


def test_no_command_comes_from_a_model_that_is_unfit(session: StudioSession) -> None:
    async def work() -> None:
        await session.choose_file("square.csv")
        await session.identify("linear")

    run(session, work)
    assert [each.level for each in session.models] == ["unfit"]
    assert session.said["reference"].startswith("No command comes from linear, which is unfit:")
    assert session.chosen == ""
    assert session.session(("c",)).method == ""


def test_a_folder_that_is_no_session_is_left_alone(session: StudioSession) -> None:
    other = session.folder.root / "mine"
    other.mkdir(exist_ok=True)
    (other / "thesis.txt").write_text("years of work")
    run(session, lambda: session.save("mine", ()))
    assert "holds no session" in session.said["save"]
    assert [each.name for each in other.iterdir()] == ["thesis.txt"]


def test_a_link_in_a_session_is_not_followed(session: StudioSession) -> None:
    other = session.folder.root / "linked"
    other.mkdir(exist_ok=True)
    (other / "commands.sh").write_text("")
    (other / "models").symlink_to(session.folder.root.parent)
    run(session, lambda: session.save("linked", ()))
    assert "holds the link models" in session.said["save"]

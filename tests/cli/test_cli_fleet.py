"""hyst fleet: globs, tables of devices, limits, the page, and what is refused."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest
from command_runs import Run, snapshot, write_csv
from pages import blocks, commands, untold

import hyst
from fleet.lots import lot

TUTORIAL = "tutorials/fleet.md"
CHEAP = "--family pi --plays 2 --delay 0 --creep none --leave-disturbances --scheduler threads"
HOW = ["--input", "u", "--output", "y", "--rate", "1000", *CHEAP.split()]


@pytest.fixture
def records(folder: Path) -> Path:
    """A folder with files of eight ordinary devices and a broken one."""
    there = folder / "records"
    there.mkdir()
    for name, each in lot(8).items():
        write_csv(there / f"{name}.csv", "u [V],y [um]", each.u, each.y)
    (there / "torn.csv").write_text("u [V],y [um]\n1,2\n3\n")
    return there


def test_a_glob_becomes_a_table_models_and_a_page(run: Run, folder: Path, records: Path) -> None:
    ended = run("fleet", "records/*.csv", *HOW, "-o", "out", "--limit", "1<gain<1.5")
    assert ended.code == 3, ended.err  # one has no model
    assert "9 devices: 8 good, 0 fair, 0 unfit, 1 without a model." in ended.out
    assert re.search(r"torn +.*line 3", ended.out)
    assert {"fleet.csv", "fleet.html", "distributions.png", "loops.png"} <= {
        each.name for each in (folder / "out").iterdir()
    }
    assert isinstance(hyst.load("out/models/D03.json"), hyst.Operator)
    page = (folder / "out" / "fleet.html").read_text()
    assert "Devices that fail the limits" in page
    assert page.count("<figure>") == 2
    # Again: nothing is left to do, and without figures there are none.
    again = run("fleet", "records/*.csv", *HOW, "-o", "out", "--no-figures")
    assert again.code == 3
    assert "data:image/png" not in (folder / "out" / "fleet.html").read_text()
    other = run("fleet", "records/*.csv", *HOW, "-o", "out", "--start", "0")
    assert other.code == 2
    assert "other options (start)" in other.err


def test_a_table_names_devices_columns_and_limits(run: Run, folder: Path, records: Path) -> None:
    (folder / "devices.csv").write_text(
        "file,identifier,input,output,rate,min gain,max rms_percent\n"
        "records/D00.csv,left,u,y,1000,,5\n"
        "records/D01.csv,right,0,1,1000,9,5\n"
        "records/D02.csv,wrong column,u,z,1000,,\n"
    )
    ended = run("fleet", "--devices", "devices.csv", *CHEAP.split(), "-o", "out", "--no-figures")
    assert ended.code == 3
    fleet = hyst.fleet.Fleet.load("out")
    assert list(fleet.table["limits"]) == ["pass", "fail", ""]
    assert re.match(r"gain .* is below 9", fleet.table.row("right")["limits_broken"])
    assert list(fleet.failures) == ["wrong column"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nothing/*.csv", *HOW], "meets no file"),
        (["records", *HOW], "'records' is a folder; give the files in it, as 'records/*.csv'"),
        ([*HOW], "give the records of the fleet"),
        (["records/D00.csv", "--rate", "1000"], "no input column is named"),
        (["records/*.csv", *HOW, "--limit", "strength<1"], "'strength', which is no quantity"),
        (["records/*.csv", *HOW, "--limit", "gain"], "is not understood"),
        (["records/*.csv", *HOW, "--limits", "none.toml"], "cannot be read as limits"),
        (["--devices", "twice.csv", *HOW], "given twice: D00"),
        (["--devices", "odd.csv", *HOW], "the column 'colour'"),
        (["--devices", "word.csv", *HOW], "row 2, max gain: 'big' is no number"),
        (["records/*.csv", *HOW, "--shape", "records"], "has no shape.json"),
    ],
)
def test_refused_before_anything_is_written(
    refused: Callable[..., str], folder: Path, records: Path, arguments: list[str], said: str
) -> None:
    row = "records/D00.csv"
    (folder / "twice.csv").write_text(f"file,identifier\n{row},D00\n{row},D00\n")
    (folder / "odd.csv").write_text(f"file,colour\n{row},red\n")
    (folder / "word.csv").write_text(f"file,max gain\n{row},big\n")
    assert said in refused("fleet", *arguments, "-o", "out")


def test_a_scheduler_that_does_not_answer_is_one_sentence(
    run: Run, folder: Path, records: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("hyst.fleet.running.cluster.SECONDS", 1)
    where = [*HOW[:-1], "tcp://127.0.0.1:9"]
    ended = run("fleet", "records/*.csv", *where, "-o", "out")
    assert ended.code == 1
    assert "the scheduler at tcp://127.0.0.1:9 does not answer" in ended.err
    assert ended.err.count("\n") == 1


def test_the_tutorial_runs(run: Run, folder: Path) -> None:
    make, first, info = (shlex.split(line) for line in commands(TUTORIAL))
    made = run(*make[1:])
    assert made.code == 0, made.err
    ended = run(*first[1:], "--scheduler", "threads")
    assert ended.code == 3, ended.err
    assert untold(TUTORIAL, ended.out) == []
    assert "lot-out" in str(snapshot(folder))
    assert run(*info[1:]).code == 0


def test_the_page_has_the_same_on_a_cluster_as_one_option_more() -> None:
    fleets = [shlex.split(line) for line in commands("fleet.md") if line.startswith("hyst fleet ")]
    first, on_cluster = fleets[:2]
    assert on_cluster[: len(first)] == first
    assert on_cluster[len(first) :] == ["--scheduler", "dask"]


def test_the_example_in_docs_runs() -> None:
    (example,) = blocks("fleet.md", "python")
    names: dict[str, object] = {}
    exec(compile(example, "fleet.md", "exec"), names)
    assert isinstance(names["fleet"], hyst.fleet.Fleet)

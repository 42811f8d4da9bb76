"""hyst identify: what it writes and says, and what it refuses."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Run, drive, snapshot, write_csv

import hyst
from hyst.report.page import Page

COLUMNS = ("--input", "u", "--output", "y")
QUICK = ("--family", "pi", "--plays", 2, "--delay", 0)
FILES = {
    "model.json",
    "metrics.json",
    "report.html",
    "loop.png",
    "history.png",
    "error.png",
    "model.png",
}


def test_without_figures_the_rest_is_the_same_and_matplotlib_stays_out(
    run: Run, record_file: Path, folder: Path
) -> None:
    for told, out in (((), "with"), (("--no-figures",), "without")):
        ended = run("identify", record_file, *COLUMNS, "--time", "t", *QUICK, *told, "-o", out)
        assert ended.code == 0, ended.err
    assert {path.name for path in (folder / "without").iterdir()} == {
        "model.json",
        "metrics.json",
        "report.html",
    }
    numbers = [(folder / out / "metrics.json").read_text() for out in ("with", "without")]
    assert numbers[0] == numbers[1]
    pages = [(folder / out / "report.html").read_text() for out in ("with", "without")]
    assert [page.count("<figure>") for page in pages] == [4, 0]
    assert pages[1].count("<table") == pages[0].count("<table") > 0
    ask = "import hyst.cli, sys; hyst.report.write_report; print('matplotlib' in sys.modules)"
    said = subprocess.run([sys.executable, "-c", ask], capture_output=True, text=True, check=True)
    assert said.stdout == "False\n"


def test_writes_the_model_the_numbers_the_figures_and_the_report(
    run: Run, record_file: Path, folder: Path
) -> None:
    ended = run("identify", record_file, *COLUMNS, "--time", "t", *QUICK, "-o", "out")
    assert ended.code == 0, ended.err
    assert ended.err == ""
    assert {path.name for path in (folder / "out").iterdir()} == FILES
    u = drive()
    found = hyst.load(folder / "out" / "model.json")
    # The record has noise of 1e-3; a model of the same family comes within a fraction of it.
    assert np.abs(found(u) - STAGE(u))[200:].max() < 1e-3
    numbers = json.loads((folder / "out" / "metrics.json").read_text())
    # The noise has a deviation of 1e-3; over some 600 samples rms is within 15 % of it.
    assert numbers["metrics"]["training"]["rms"] == pytest.approx(1e-3, rel=0.15)
    assert numbers["family"] == "pi"
    for part in ("Prandtl-Ishlinskii model with 2 plays", "training", "rms [um]", "p[1]", "wrote"):
        assert part in ended.out


def test_model_file_knows_names_units_ranges_and_sample_time(
    run: Run, record_file: Path, folder: Path
) -> None:
    run("identify", record_file, *COLUMNS, "--time", "t", *QUICK, "-o", "out")
    about = hyst.load(folder / "out" / "model.json").description
    assert (about.input_name, about.input_unit) == ("u", "V")
    assert (about.output_name, about.output_unit) == ("y", "um")
    assert (about.input_low, about.input_high) == (drive().min(), drive().max())
    assert about.dt == pytest.approx(0.01, rel=1e-12)


def test_columns_by_index_rate_labels_validation_and_several_records(
    run: Run, record_file: Path, folder: Path
) -> None:
    ended = run(
        *("identify", record_file, record_file, "--input", 1, "--output", 2, "--rate", 100),
        *(*QUICK, "--validate", record_file, "--validate", record_file, "-o", "out"),
        *("--input-label", "drive [mV]", "--output-label", "stroke"),
    )
    assert ended.code == 0, ended.err
    about = hyst.load(folder / "out" / "model.json").description
    assert (about.input_name, about.input_unit) == ("drive", "mV")
    assert (about.output_name, about.output_unit) == ("stroke", "")
    assert "validation 1" in ended.out
    assert "validation 2" in ended.out


def test_time_in_milliseconds_and_repaired_rows(run: Run, folder: Path) -> None:
    u = drive()
    write_csv(folder / "loop.csv", "t,u,y", np.arange(u.size) * 10.0, u, STAGE(u))
    lines = (folder / "loop.csv").read_text().splitlines()
    lines[99] = "980.0,nan,1.0"
    (folder / "loop.csv").write_text("\n".join(lines) + "\n")
    arguments = ("identify", "loop.csv", *COLUMNS, "--time", "t", "--time-unit", "ms", *QUICK)
    assert run(*arguments, "-o", "out").code == 2
    ended = run(*arguments, "--repair", "-o", "out")
    assert ended.code == 0, ended.err
    about = hyst.load(folder / "out" / "model.json").description
    assert about.dt == pytest.approx(0.01, rel=1e-12)
    assert "left out 1 row" in (folder / "out" / "report.html").read_text()


def test_a_fit_that_did_not_converge_is_a_failure_unless_it_is_accepted(
    run: Run, record_file: Path, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    identify = hyst.identify

    def hurried(records: list[hyst.Record], **options: object) -> hyst.Identified:
        return identify(records, **(options | {"max_iterations": 1}))  # type: ignore[arg-type]

    monkeypatch.setattr("hyst.identify", hurried)
    arguments = ("identify", record_file, *COLUMNS, "--time", "t", "--family", "mpi", "--plays", 8)
    refused = run(*arguments, "-o", "out")
    assert refused.code == 1
    assert "did not converge" in refused.err
    assert not (folder / "out").exists()
    accepted = run(*arguments, "--allow-unconverged", "-o", "out")
    assert accepted.code == 0, accepted.err
    assert (folder / "out" / "report.html").is_file()


def test_auto_shows_what_it_compared_and_what_it_chose(run: Run, record_file: Path) -> None:
    ended = run(
        *("identify", record_file, *COLUMNS, "--time", "t", "--plays", 1, "--delay", 0),
        *("-o", "out"),
    )
    assert ended.code == 0, ended.err
    lines = [line.split() for line in ended.out.splitlines() if line.startswith("  ")]
    families = [words[0] for words in lines if words[0] in {"linear", "pi", "gpi", "mpi"}]
    assert families == ["linear", "pi", "gpi", "mpi"]
    assert ended.out.count("<- chosen") == 1


def test_replaces_its_own_files_when_asked_and_leaves_others(
    run: Run, record_file: Path, folder: Path
) -> None:
    (folder / "out").mkdir()
    (folder / "out" / "notes.txt").write_text("mine")
    (folder / "out" / "model.json").write_text("old")
    words = ("identify", record_file, *COLUMNS, "--time", "t", *QUICK, "-o", "out")
    before = snapshot(folder)
    ended = run(*words)
    assert ended.code == 2
    assert "the folder out holds files already" in ended.err
    assert snapshot(folder) == before
    ended = run(*words, "--force")
    assert ended.code == 0
    assert (folder / "out" / "notes.txt").read_text() == "mine"
    assert {path.name for path in (folder / "out").iterdir()} == FILES | {"notes.txt"}
    hyst.load(folder / "out" / "model.json")
    assert not list(folder.glob(".hyst-*"))


def test_a_failure_while_writing_leaves_everything_as_it_was(
    run: Run, record_file: Path, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: Page) -> str:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Page, "to_html", fail)
    (folder / "old").mkdir()
    (folder / "old" / "model.json").write_text("old")
    before = snapshot(folder)
    for target in ("new", "old"):
        out = ("-o", target, "--force")
        ended = run("identify", record_file, *COLUMNS, "--time", "t", *QUICK, *out)
        assert ended.code == 1
        assert "No space left" in ended.err
        assert snapshot(folder) == before


def column(values: np.ndarray) -> np.ndarray:
    return np.asarray(values, dtype=float)


U = drive(200)
Y = STAGE(U)
T = np.arange(200) * 0.01


def broken_rows(folder: Path, line: int, row: str) -> Path:
    path = write_csv(folder / "bad.csv", "t [s],u [V],y [um]", T, U, Y)
    lines = path.read_text().splitlines()
    lines[line - 1] = row
    path.write_text("\n".join(lines) + "\n")
    return path


def uneven(folder: Path) -> Path:
    t = T.copy()
    t[100:] += 0.5
    return write_csv(folder / "bad.csv", "t,u,y", t, U, Y)


BAD_DATA: dict[str, tuple[Callable[[Path], Path], tuple[str, ...]]] = {
    "NaN": (lambda f: broken_rows(f, 7, "0.05,nan,1.0"), ("'u'", "nan", "line 7")),
    "text": (lambda f: broken_rows(f, 9, "0.07,1.0,oops"), ("'y'", "oops", "line 9")),
    "missing value": (lambda f: broken_rows(f, 5, "0.03,,1.0"), ("'u'", "line 5")),
    "uneven time": (uneven, ("uneven", "0.51", "line 101")),
    "constant input": (
        lambda f: write_csv(f / "bad.csv", "t,u,y", T, np.full(200, 3.0), Y),
        ("'u'", "3 throughout"),
    ),
    "constant output": (
        lambda f: write_csv(f / "bad.csv", "t,u,y", T, U, np.full(200, 2.0)),
        ("'y'", "2 throughout"),
    ),
    "no reversal": (
        lambda f: write_csv(f / "bad.csv", "t,u,y", T, T, T),
        ("'u'", "reversals"),
    ),
    "empty file": (lambda f: write_csv(f / "bad.csv", "t,u,y"), ("bad.csv",)),
    "no such column": (
        lambda f: write_csv(f / "bad.csv", "t,volts,y", T, U, Y),
        ("no column 'u'", "t, volts, y"),
    ),
    "no such file": (lambda f: f / "nowhere.csv", ("nowhere.csv",)),
    "too few samples": (
        lambda f: write_csv(f / "bad.csv", "t,u,y", T[:5], np.array([0, 4, 0, 4, 0.0]), Y[:5]),
        ("samples",),
    ),
}


@pytest.mark.parametrize("name", BAD_DATA)
def test_bad_data_are_refused(name: str, refused: Callable[..., str], folder: Path) -> None:
    make, parts = BAD_DATA[name]
    message = refused("identify", make(folder), *COLUMNS, "--time", "t", *QUICK, "-o", "out")
    for part in parts:
        assert part in message


def test_bad_validation_data_are_refused(
    refused: Callable[..., str], record_file: Path, folder: Path
) -> None:
    bad = broken_rows(folder, 7, "0.05,nan,1.0")
    message = refused(
        "identify", record_file, *COLUMNS, "--time", "t", *QUICK, "--validate", bad, "-o", "out"
    )
    assert Path(bad).name in message


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("--time", "t", "--rate", 100), "both"),
        ((), "neither"),
        (("--rate", 0), "rate"),
        (("--rate", "fast"), "number"),
        (("--time", "t", "--family", "duhem"), "mpi"),
        (("--time", "t", "--plays", "many"), "--plays"),
        (("--time", "t", "--plays", 0), "plays"),
        (("--time", "t", "--plays", 2, "--knots", -1), "knots"),
        (("--rate", 100, "--time-unit", "ms"), "time_unit"),
        (("--time", "t", "--weights", "heavy"), "non-negative"),
        (("--time", "t", "--delay", "soon"), "delay"),
        (("--time", "t", "--start", 100000), "start"),
        (("--time", "t", "--nonsense", 1), "--nonsense"),
    ],
)
def test_bad_arguments_are_refused(
    arguments: tuple[object, ...], part: str, refused: Callable[..., str], record_file: Path
) -> None:
    message = refused("identify", record_file, *COLUMNS, *arguments, "-o", "out")
    assert part in message


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (
            ("--family", "ramberg-osgood", "--plays", 3),
            "pi, rdpi, gpi, mpi",
        ),
        (("--family", "linear", "--plays", "auto"), "not for linear; leave it out"),
        (("--family", "pi", "--knots", 4), "--knots is for"),
        (("--family", "pi", "--hysteresis", "mpi"), "--hysteresis is for --family hammerstein"),
        (("--fir-order", 30), "--fir-order is for --family hammerstein"),
        (("--state-order", 2), "not for linear, pi, gpi or mpi;"),
        (("--family", "pi,mpi", "--spacing", "free"), "--spacing is for --family rdpi"),
        (("--family", "rdpi", "--weights", "invertible"), "--weights is for"),
        (("--family", "rdpi", "--memory", "masing"), "--memory is for --family ramberg-osgood"),
        (("--family", "hammerstein", "--hysteresis", "pi", "--knots", 4), "gpi, mpi"),
        (("--family", "hammerstein", "--hysteresis", "linear", "--plays", 4), "not for linear"),
        (("--family", "ramberg-osgood", "--signal-to-noise", 5), "choose regression 'slope'"),
    ],
)
def test_options_that_would_be_passed_over_are_refused(
    arguments: tuple[object, ...], says: str, refused: Callable[..., str], record_file: Path
) -> None:
    assert says in refused(
        "identify", record_file, *COLUMNS, "--time", "t", *arguments, "-o", "out"
    )


def test_an_option_that_one_of_several_families_takes_is_used(run: Run, record_file: Path) -> None:
    options = ("--family", "linear,pi", "--plays", 1, "--delay", 0)
    assert run("identify", record_file, *COLUMNS, "--time", "t", *options, "-o", "out").code == 0


def test_a_record_is_needed(refused: Callable[..., str]) -> None:
    assert "DATA" in refused("identify", *COLUMNS, "--rate", 1, "-o", "out")


@pytest.mark.parametrize("target", ["file.txt", "file.txt/deep/out"])
def test_a_folder_that_cannot_be_is_refused_before_anything_is_read(
    target: str, refused: Callable[..., str], folder: Path
) -> None:
    (folder / "file.txt").write_text("")
    message = refused("identify", "nowhere.csv", *COLUMNS, "--rate", 100, "-o", target)
    assert "nowhere.csv" not in message
    assert target.split("/")[0] in message


def test_a_folder_in_the_place_of_a_file_is_refused(
    run: Run, record_file: Path, folder: Path
) -> None:
    (folder / "out" / "model.json").mkdir(parents=True)
    before = snapshot(folder)
    out = ("-o", "out", "--force")
    ended = run("identify", record_file, *COLUMNS, "--time", "t", *QUICK, *out)
    assert ended.code == 2
    assert "model.json is a folder" in ended.err
    assert snapshot(folder) == before


def test_validation_records_may_call_their_columns_otherwise(
    run: Run, refused: Callable[..., str], record_file: Path, folder: Path
) -> None:
    other = write_csv(folder / "other.csv", "stamp,volts,y,position", T, U, T, Y)
    words = ("identify", record_file, *COLUMNS, "--time", "t", *QUICK, "-o", "out")
    message = refused(*words, "--validate", other)
    assert "no column 'u'" in message
    assert "--validate-input" in message
    message = refused(*words, "--validate-output", "position")
    assert "--validate-output names a column of validation records, and there are none" in message
    columns = ("--validate-input", "volts", "--validate-output", "position")
    ended = run(*words, "--validate", other, *columns, "--validate-time", "stamp")
    assert ended.code == 0, ended.err
    numbers = (folder / "out" / "metrics.json").read_text(encoding="utf-8")
    plain = write_csv(folder / "plain.csv", "t,u,y", T, U, Y)
    assert run(*words, "--validate", plain, "--force").code == 0
    again = (folder / "out" / "metrics.json").read_text(encoding="utf-8")
    # The same signals under other names.
    assert (
        json.loads(numbers)["metrics"]["validation"] == (json.loads(again)["metrics"]["validation"])
    )

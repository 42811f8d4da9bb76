"""Options for reading: tables, formats, repair and its limits, and that all is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Run, describe, drive

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

COLUMNS = ("--input", "drive", "--output", "stroke")
QUICK = ("--family", "pi", "--plays", "2", "--delay", "0", "-o", "out")


def lines(samples: int = 300) -> list[str]:
    u = drive(samples)
    y, _ = STAGE.run(u, STAGE.initial_state())
    stamps = 0.01 * np.arange(samples)
    return [f"{t:.2f},{a:.6f},{b:.6f}" for t, a, b in zip(stamps, u, y, strict=True)]


def written(*parts: list[str], name: str = "loop.csv") -> str:
    Path(name).write_text("\n".join(line for part in parts for line in part) + "\n")
    return name


HEADER = ["time_s,drive_V,stroke_um"]


def test_one_table_or_each_as_a_record(run: Run) -> None:
    path = written(HEADER, lines(), [""], HEADER, lines(250))
    refused = run("identify", path, *COLUMNS, "--time", "time", *QUICK)
    assert refused.code == 2
    assert "holds 2 tables below each other (1: 300 rows from line 2 on" in refused.err
    one = run("identify", path, *COLUMNS, "--time", "time", "--table", "2", *QUICK)
    assert one.code == 0
    both = run("identify", path, *COLUMNS, "--time", "time", "--table", "all", *QUICK, "--force")
    assert both.code == 0
    report = Path("out/report.html").read_text()
    assert "loop.csv, table 1" in report
    assert "loop.csv, table 2" in report
    wrong = run("identify", path, *COLUMNS, "--time", "time", "--table", "two", *QUICK, "--force")
    assert (wrong.code, "--table is 'two'; give a whole number or all" in wrong.err) == (2, True)


def test_repair_is_told_and_limited(run: Run) -> None:
    rows = lines()
    for k in (100, 101, 102, 103, 104, 105):
        rows[k] = f"{0.01 * k:.2f},,"
    path = written(HEADER, rows)
    timed = (*COLUMNS, "--time", "time")
    refused = run("identify", path, *timed, *QUICK)
    assert "'drive' has no value at line 102" in refused.err
    far = run("identify", path, *timed, "--repair", *QUICK)
    assert (far.code, "repair bridges 5 at most" in far.err) == (2, True)
    done = run("identify", path, *timed, "--repair", "--longest-gap", "6", *QUICK)
    assert done.code == 0
    assert "note: loop.csv: left out 6 rows that held no number or no finite one" in done.err


def test_a_dead_band_that_a_refusal_names_can_be_given(run: Run) -> None:
    u = np.concatenate([np.linspace(0, 4, 200), np.linspace(4, 0, 200)])
    u += 0.02 * np.random.default_rng(4).standard_normal(400)
    y, _ = STAGE.run(u, STAGE.initial_state())
    path = written(
        HEADER, [f"{0.01 * k:.2f},{a},{b}" for k, (a, b) in enumerate(zip(u, y, strict=True))]
    )
    wide = run("identify", path, *COLUMNS, "--rate", "100", "--dead-band", "5", *QUICK)
    assert wide.code == 2
    assert "has 0 reversals beyond its dead band of 5" in wide.err
    assert "give a smaller dead_band" in wide.err
    assert run("identify", path, *COLUMNS, "--rate", "100", "--dead-band", "0.5", *QUICK).code == 0


def test_one_whole_loop_is_identified(run: Run) -> None:
    u = np.concatenate([np.linspace(0, 4, 200), np.linspace(4, 0, 201)[1:]])
    y, _ = STAGE.run(u, STAGE.initial_state())
    path = written(
        HEADER, [f"{0.01 * k:.2f},{a},{b}" for k, (a, b) in enumerate(zip(u, y, strict=True))]
    )
    done = run("identify", path, *COLUMNS, "--rate", "100", *QUICK)
    assert done.code == 0


OF_A_FILE = ("--table", "--format", "--max-samples")
OF_A_RECORD = (
    *OF_A_FILE,
    *("--input", "--output", "--time", "--time-unit", "--rate", "--repair", "--longest-gap"),
    *("--dead-band", "--resample", "--hold-input", "--input-time", "--output-time"),
    "--output-file",
)


@pytest.mark.parametrize(
    ("verb", "options"),
    [
        *((verb, OF_A_RECORD) for verb in ("identify", "fit", "adapt", "diagnose")),
        *((verb, OF_A_FILE) for verb in ("simulate", "compensate", "columns")),
    ],
)
def test_all_verbs_that_read_take_the_options(
    run: Run, verb: str, options: tuple[str, ...]
) -> None:
    shown = run(verb, "--help").out.split()
    assert set(options) <= set(shown)


def test_diagnosis_numbers_the_records_of_all_tables(run: Run) -> None:
    path = written(HEADER, lines(), [""], HEADER, lines(250))
    timed = (*COLUMNS, "--time", "time")
    refused = run("diagnose", path, *timed)
    assert (refused.code, "choose one with table" in refused.err) == (2, True)
    told = run("diagnose", path, *timed, "--table", "all")
    assert told.code == 0
    assert "record 2: loop.csv, table 2" in told.out


def test_diagnosis_tells_what_was_repaired(run: Run) -> None:
    rows = lines()
    rows[40], rows[90] = "0.40,,", "0.90,1.0,9.9E37"
    path = written(HEADER, rows)
    timed = (*COLUMNS, "--time", "time")
    assert run("diagnose", path, *timed).code == 2
    told = run("diagnose", path, *timed, "--repair")
    assert told.code == 0
    assert "left out 1 row that held no number" in told.err
    assert "left out 1 row where 'stroke' is 9.9e+37" in told.err
    assert "no measurement (instruments write it for an overload)" in told.err


@pytest.mark.parametrize("verb", ["simulate", "compensate"])
def test_a_signal_and_its_time_are_those_of_the_table_asked_for(run: Run, verb: str) -> None:
    STAGE.with_description(describe(STAGE, dt=None, delay=0)).save("model.json")
    slow = [f"{0.02 * k:.2f},{2 + k % 2}" for k in range(40)]
    fast = [f"{0.01 * k:.2f},{2.5 + k % 2}" for k in range(30)]
    path = written(["time_s,drive_V"], slow, [""], ["time_s,drive_V"], fast, name="loop.h5")
    column = "--input" if verb == "simulate" else "--column"
    wanted = (verb, "model.json", path, column, "1", "--format", "text", "-o", "out.csv")
    if verb == "compensate":
        Path(path).write_text(Path(path).read_text().replace("drive_V", "stroke_um"))
    refused = run(*wanted)
    assert (refused.code, "holds 2 tables" in refused.err) == (2, True)
    assert run(*wanted, "--table", "2").code == 0
    out = np.loadtxt("out.csv", delimiter=",", skiprows=1)
    assert out[:, 0].tolist() == [round(0.01 * k, 2) for k in range(30)]
    assert out[:2, 1].tolist() == [2.5, 3.5]


def test_format_and_limit(run: Run) -> None:
    path = written(HEADER, lines(), name="loop.h5")
    timed = (*COLUMNS, "--time", "time")
    assert run("identify", path, *timed, *QUICK).code == 2
    assert run("identify", path, *timed, "--format", "text", *QUICK).code == 0
    few = ("--max-samples", "100", "--force")
    many = run("identify", path, *timed, "--format", "text", *few, *QUICK)
    assert (many.code, "at most 100 are read" in many.err) == (2, True)


def test_the_columns_of_one_of_several_tables(run: Run) -> None:
    path = written(HEADER, lines(), ["", "f,A,B", *["1,2,3", "2,3,4", "3,4,6", "4,1,2"]])
    refused = run("columns", path)
    assert (refused.code, "holds 2 tables below each other" in refused.err) == (2, True)
    shown = run("columns", path, "--table", "2")
    assert (shown.code, "0: f" in shown.out) == (0, True)
    first = run("columns", path, "--table", "1")
    assert "--time time --table 1 -o out" in first.out
    assert "refused" not in first.err

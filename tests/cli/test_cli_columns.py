"""hyst columns, and the small things of reading and writing files on the command line."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from command_runs import STAGE, Run, describe, drive, write_csv

import hyst

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

U = drive(400)
T = np.arange(U.size) * 0.01


def test_lists_columns_and_a_command_that_works(run: Run, folder: Path) -> None:
    signals = {"Data": U, "Name": "piezo", "Unit": "V"}, {"Data": STAGE(U), "Name": "gap"}
    scipy.io.savemat(folder / "log.mat", {"t": T, "u": signals[0], "y": signals[1], "z": U + 1j})
    ended = run("columns", "log.mat")
    assert ended.code == 0
    assert "note: no column: 'z' is complex" in ended.err
    row = next(line for line in ended.out.splitlines() if "u.Data" in line)
    top = hyst.report.number(U.max(), 6)
    assert row.split() == ["1:", "u.Data", "piezo", "V", "400", "0", top, "input"]
    assert "refused" not in ended.err
    command = ended.out.split("if the guess is right: hyst ")[1]
    assert run(*shlex.split(command), "--family", "pi", "--plays", "2").code == 0
    assert (folder / "out" / "model.json").is_file()


def test_columns_refuses_what_no_verb_reads(refused: Callable[..., str], folder: Path) -> None:
    (folder / "log.mat").write_bytes(b"\0" * 300)
    assert "damaged or no MATLAB file" in refused("columns", "log.mat")
    assert "does not exist" in refused("columns", "nowhere.csv")


def apart(folder: Path) -> Path:
    """Write an input at 100 Hz and an output at 50 Hz, each with its own time."""
    y = STAGE(U)[::2]
    rows = ["time,cmd,time_pos,pos"]
    for k in range(U.size):
        more = f"{T[2 * k]!r},{y[k]!r}" if k < y.size else ","
        rows.append(f"{T[k]!r},{U[k]!r},{more}".replace("np.float64(", "").replace(")", ""))
    path = folder / "log.csv"
    path.write_text("\n".join(rows) + "\n")
    return path


def test_two_clocks_are_refused_and_then_resampled_with_a_note(
    run: Run, refused: Callable[..., str], folder: Path
) -> None:
    apart(folder)
    columns = ("log.csv", "--input", "cmd", "--output", "pos", "--time", "time", "-o", "out")
    quick = ("--family", "pi", "--plays", "2")
    told = run("columns", "log.csv")
    assert "as it stands that is refused: log.csv: 'pos' has its own stamps" in told.err
    message = refused("identify", *columns, *quick)
    assert "'pos' has its own stamps in 'time_pos'" in message
    ended = run("identify", *columns, "--output-time", "time_pos", "--resample", *quick)
    assert ended.code == 0
    assert "note: log.csv: brought to the stamps of 'pos': 200 samples, step 0.02 s" in ended.err
    weights = hyst.load(folder / "out" / "model.json").parameters()
    found = dict(zip(weights.names, weights.values.tolist(), strict=True))
    # The stage has p0 of 1; without noise the grid of radii is what remains.
    assert found["prandtl_ishlinskii.p0"] == pytest.approx(1.0, abs=0.02)


def test_a_channel_a_file(run: Run, refused: Callable[..., str], folder: Path) -> None:
    write_csv(folder / "u.csv", "t,u", T, U)
    write_csv(folder / "y.csv", "t,y", T, STAGE(U))
    options = ("--input", "u", "--output", "y", "--time", "t", "--output-file", "y.csv")
    quick = ("--family", "pi", "--plays", "2", "-o", "out")
    assert run("identify", "u.csv", *options, *quick).code == 0
    several = refused("identify", "u.csv", "u.csv", *options, *quick, "--force")
    assert "--output-file is the output of one record, and 2 are given" in several


def test_more_than_allowed_is_refused_in_one_sentence(
    refused: Callable[..., str], folder: Path
) -> None:
    np.savez(folder / "log.npz", u=U, y=STAGE(U))
    options = ("--input", "u", "--output", "y", "--rate", 100, "-o", "out")
    message = refused("identify", "log.npz", *options, "--max-samples", 500)
    assert "holds 800 numbers" in message


# Time along with a command


@pytest.fixture
def model_file(folder: Path) -> Path:
    STAGE.save(folder / "model.json", describe(STAGE))
    return folder / "model.json"


@pytest.mark.parametrize("header", ["time [s]", "t", "Time (ms)"])
def test_the_time_of_the_reference_stands_in_the_command(
    run: Run, model_file: Path, folder: Path, header: str
) -> None:
    stamps = T * (1000.0 if "ms" in header else 1.0) + 3.0
    write_csv(folder / "ref.csv", f"{header},wanted", stamps, STAGE(U))
    assert run("compensate", "model.json", "ref.csv", "--column", "wanted", "-o", "c.csv").code == 0
    first = (folder / "c.csv").read_text().splitlines()[0]
    assert first == f"{header},reference [um],command [V],predicted [um]"
    assert np.array_equal(hyst.io.read_column(folder / "c.csv", 0)[0], stamps)
    write_csv(folder / "drive.csv", f"{header},u", stamps, U)
    assert run("simulate", "model.json", "drive.csv", "--input", "u", "-o", "y.csv").code == 0
    assert np.array_equal(hyst.io.read_column(folder / "y.csv", 0)[0], stamps)


def test_a_rate_makes_the_time_and_without_one_there_is_none(
    run: Run, model_file: Path, folder: Path
) -> None:
    write_csv(folder / "ref.csv", "wanted", STAGE(U))
    compensate = ("compensate", "model.json", "ref.csv", "--column", 0, "-o", "c.csv")
    assert run(*compensate).code == 0
    assert (folder / "c.csv").read_text().startswith("reference [um],")
    assert run(*compensate, "--rate", 1000, "--force").code == 0
    assert (folder / "c.csv").read_text().startswith("time [s],reference [um],")
    stamps = hyst.io.read_column(folder / "c.csv", 0)[0]
    assert np.array_equal(stamps, np.arange(U.size) / 1000.0)


# A sensor that counts the other way


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_gain_that_turns_the_output_round_is_printed(run: Run, folder: Path, sign: float) -> None:
    noise = np.random.default_rng(4).normal(0.0, 1e-3, U.size)
    write_csv(folder / "loop.csv", "t [s],u [V],y [um]", T, U, 10.0 + sign * STAGE(U) + noise)
    options = ("--input", "u", "--output", "y", "--time", "t", "--family", "pi", "--plays", 2)
    ended = run("identify", "loop.csv", *options, "-o", "out")
    assert ended.code == 0
    gains = [line.split() for line in ended.out.splitlines() if "gain" in line]
    assert gains == ([] if sign > 0 else [["affine.gain", "-1", "fixed"]])
    report = (folder / "out" / "report.html").read_text()
    assert (re.search(r"affine\.gain\W.{0,60}fixed", report, re.DOTALL) is not None) == (sign < 0)


# A drive from rest


def test_a_drive_starts_at_rest_on_request_and_says_where_it_starts(
    run: Run, refused: Callable[..., str], folder: Path
) -> None:
    excite = ("excite", "--kind", "triangle", "--rate", 1000, "--amplitude", 50, "--offset", 50)
    excite += ("--max-rate", 400, "--periods", 2)
    ended = run(*excite, "-o", "plain.csv")
    assert {"starts", "ends"} <= {
        line.split()[0] for line in ended.out.splitlines() if line.split()
    }
    rows = [line.split() for line in ended.out.splitlines()]
    assert ["starts", "at", "50"] in rows
    assert ["ends", "at", "50"] in rows
    ended = run(*excite, "--rest", 0, "-o", "drives/rest.csv")
    rows = [line.split() for line in ended.out.splitlines()]
    assert ["starts", "at", "0"] in rows
    assert ["ends", "at", "0"] in rows
    u = hyst.io.read_column(folder / "drives" / "rest.csv", "u")[0]
    assert np.abs(np.diff(u, prepend=0.0, append=0.0)).max() * 1000.0 <= 400.0
    lonely = ("excite", "--kind", "multisine", "--rate", 100, "--rest", 0, "-o", "x.csv")
    assert "a ramp from rest needs one" in refused(*lonely)

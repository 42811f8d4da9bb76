"""hyst diagnose: what is printed and written, and that the proposed command runs."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, write_csv

DT = 1e-3


@pytest.fixture
def drifting(folder: Path) -> Path:
    """A line and one play under a triangle, with a drift of 2 um/s."""
    phase = (np.arange(4000) / 500.0) % 1.0
    u = 100.0 * (1.0 - np.abs(2.0 * phase - 1.0))
    z, play = 0.0, []
    for value in u.tolist():
        z = max(value - 5.0, min(value + 5.0, z))
        play.append(z)
    t = np.arange(u.size) * DT
    y = 0.3 * u + 0.2 * np.array(play) + 2.0 * t
    y += 0.02 * np.random.default_rng(1).standard_normal(u.size)
    return write_csv(folder / "loop.csv", "time [s],drive [V],stroke [um]", t, u, y)


COLUMNS = ("--input", "drive", "--output", "stroke", "--time", "time")


def test_worst_first_with_numbers_and_advice(run: Run, drifting: Path) -> None:
    ended = run("diagnose", drifting, *COLUMNS)
    assert (ended.code, ended.err) == (0, "")
    assert "warning: drift: the output drifts by 2 um/s" in ended.out
    kinds = [line.split(":")[0] for line in ended.out.splitlines() if line and line[0] != " "]
    assert kinds == sorted(kinds, key=["refusal", "left out", "warning", "remark"].index)
    assert {"warning", "remark"} == set(kinds)


def test_findings_as_json(run: Run, drifting: Path) -> None:
    assert run("diagnose", drifting, *COLUMNS, "-o", "found.json").code == 0
    found = json.loads(Path("found.json").read_text())
    rates = [each["amounts"]["rate"] for each in found["findings"] if each["name"] == "drift"]
    assert rates == [pytest.approx(2.0, abs=0.01)]
    assert found["next_drive"].startswith("hyst excite ")


def test_next_drive_is_what_its_command_writes(run: Run, drifting: Path) -> None:
    ended = run("diagnose", drifting, *COLUMNS, "--next", "proposed.csv")
    assert ended.code == 0
    assert Path("proposed.png").is_file()
    (line,) = [each for each in ended.out.splitlines() if "hyst excite" in each]
    command = shlex.split(line[line.index("hyst excite") : line.index(" (it starts")])
    assert run(*command[1:]).code == 0
    assert Path("next.csv").read_bytes() == Path("proposed.csv").read_bytes()


def test_several_files_are_numbered(run: Run, folder: Path, drifting: Path) -> None:
    t, u, y = np.loadtxt(drifting, delimiter=",", skiprows=1).T
    y = y - 2.0 * t
    files = [write_csv(folder / f"{n}.csv", "time,drive,stroke", t, u, y) for n in ("a", "b")]
    third = write_csv(folder / "c.csv", "time,drive,stroke", t, u, 1.1 * y)
    ended = run("diagnose", *files, third, *COLUMNS, "--time-unit", "s")
    assert ended.code == 0
    assert f"record 3: {third}" in ended.out
    assert "warning: records that differ: record 3 differs" in ended.out


def test_what_cannot_be_read_or_written(run: Run, folder: Path, drifting: Path) -> None:
    ended = run("diagnose", drifting, "--input", "volts", "--output", "stroke", "--rate", "1000")
    assert ended.code == 2
    assert "has no column" in ended.err
    ended = run("diagnose", drifting, *COLUMNS, "-o", drifting / "found.json")
    assert ended.code == 2
    assert "loop.csv" in ended.err
    assert run("diagnose", drifting, *COLUMNS, "-o", "new/found.json").code == 0
    assert (folder / "new" / "found.json").is_file()

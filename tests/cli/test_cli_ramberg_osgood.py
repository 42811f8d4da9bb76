"""The verbs with a Ramberg-Osgood model: identify, compare, simulate, compensate."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.cli import main

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    t = np.arange(0.0, 3.0, 2e-3)
    u = 100.0 * np.sin(2.0 * np.pi * t)
    y = hyst.RambergOsgood(1.0, 0.02, 0.9)(u) + 5.0
    y += 1e-3 * np.ptp(y) * np.random.default_rng(0).normal(size=y.size)
    path = tmp_path / "record.csv"
    np.savetxt(path, np.column_stack([t, u, y]), delimiter=",", header="t,u,y", comments="")
    return path


COLUMNS = ["--input", "u", "--output", "y", "--time", "t"]


@pytest.mark.parametrize("memory", ["masing", "last-reversal"])
def test_from_a_record_to_a_command(recorded: Path, tmp_path: Path, capsys, memory: str) -> None:
    out = tmp_path / "out"
    arguments = ["--family", "ramberg-osgood", "--memory", memory, "-o", str(out)]
    assert main(["identify", str(recorded), *COLUMNS, *arguments]) == 0
    assert "Ramberg-Osgood" in capsys.readouterr().out
    model = hyst.load(out / "model.json")
    c1, c2, c3 = model.parameters().values[:3]
    # 0.1 % noise tells the slope at 100 V of way to a few percent.
    assert c1 + c2 * 100.0**c3 == pytest.approx(1.0 + 0.02 * 100.0**0.9, rel=0.05)
    reference = tmp_path / "reference.csv"
    wanted = 5.0 + 80.0 * np.sin(np.linspace(0.0, 12.0, 300))
    np.savetxt(reference, wanted, header="y_ref", comments="")
    command = tmp_path / "command.csv"
    asked = ["compensate", str(out / "model.json"), str(reference), "--column", "y_ref"]
    assert main([*asked, "-o", str(command)]) == 0
    assert command.stat().st_size > 0


def test_slopes_give_no_standard_errors(recorded: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    arguments = ["--family", "ramberg-osgood", "--regression", "slope", "-o", str(out)]
    assert main(["identify", str(recorded), *COLUMNS, *arguments]) == 0
    found = json.loads((out / "metrics.json").read_text())
    assert "standard_error" in json.dumps(found)
    assert all(each["standard_error"] is None for each in _parameters(found))


def _parameters(found: dict) -> list[dict]:
    if "parameters" in found:
        return found["parameters"]
    return next(each["parameters"] for each in found.values() if "parameters" in each)


def test_several_families_in_one_table(recorded: Path, tmp_path: Path, capsys) -> None:
    out = tmp_path / "out"
    arguments = ["--family", "pi,mpi,ramberg-osgood", "--plays", "3", "-o", str(out)]
    assert main(["identify", str(recorded), *COLUMNS, *arguments]) == 0
    printed = capsys.readouterr().out
    for family in ("pi", "mpi", "ramberg-osgood"):
        assert family in printed
    # The record is of that family, with the fewest constants.
    assert "The model is a Ramberg-Osgood model" in printed


def test_refusals(recorded: Path, tmp_path: Path, capsys) -> None:
    start = ["identify", str(recorded), *COLUMNS, "-o", str(tmp_path / "out"), "--family"]
    for arguments, part in (
        (
            ["ramberg-osgood", "--memory", "none"],
            "--memory is 'none'; choose one of masing, last-reversal",
        ),
        (["ramberg-osgood", "--regression", "none"], "choose one of output, slope"),
        (["pi,none"], "unknown family 'none'"),
    ):
        assert main([*start, *arguments]) == 2
        assert part in capsys.readouterr().err

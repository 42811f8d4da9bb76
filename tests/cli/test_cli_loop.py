"""hyst loop: new sines give loops behind the dynamics, a figure, tables, and an exit code."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, write_csv

import hyst
from hyst.operators import ModelDescription

DT = 1e-3
FRONT = hyst.PrandtlIshlinskii([0.2, 0.15, 0.1], [0.5, 1.5, 3.0], p0=0.6)
COLUMNS = ("--input", "drive", "--output", "position", "--time", "t")


def stage(late: int = 2) -> hyst.operators.Operator:
    """Plays with dynamics behind them: a zero outside the circle and a delay, gain 1 at rest."""
    G = hyst.LinearDynamics.from_zeros_poles_gain([1.6], [0.5, 0.3 + 0.4j, 0.3 - 0.4j], 1.0, DT)
    G = G.in_units(1.0, 1.0 / G.dc_gain())
    return hyst.LinearDynamics(G.A, G.B, G.C, G.D, DT, late) @ FRONT


def write_sine(path: Path, frequency: float, actuator: hyst.operators.Operator) -> Path:
    k = np.arange(int(6.0 / frequency / DT) + 60)
    u = 5.0 * np.sin(2.0 * np.pi * frequency * DT * k)
    y = actuator(u) + 0.01 * np.random.default_rng(int(frequency)).normal(size=u.size)
    return write_csv(path, "t [s],drive [V],position [um]", k * DT, u, y)


@pytest.fixture
def model(folder: Path) -> Path:
    about = ModelDescription(
        input_name="drive",
        input_unit="V",
        output_unit="um",
        input_low=-5.0,
        input_high=5.0,
        dt=DT,
        family="hammerstein",
    )
    path = folder / "model.json"
    stage().save(path, about)
    return path


@pytest.fixture
def sines(folder: Path) -> list[Path]:
    return [write_sine(folder / f"sine{f}.csv", f, stage()) for f in (4, 10, 25)]


def test_loops_that_coincide(run: Run, model: Path, sines: list[Path], folder: Path) -> None:
    ended = run("loop", model, *sines, *COLUMNS, "-o", "out")
    assert ended.code == 0, ended
    assert ended.err == ""
    assert ended.out.startswith("The loops coincide as far as noise lets one see (3 loops of 4 to")
    rows = [line.split() for line in ended.out.splitlines() if line.startswith("  ")]
    assert [row[0] for row in rows if row[0].endswith(".csv")] == [each.name for each in sines]
    gains = {row[0]: float(row[5]) for row in rows if row[1].endswith(".csv") and len(row) == 10}
    assert set(gains) == {"4", "10", "25"}
    # Percent of the model's; the noise makes 0.05 of it.
    assert list(gains.values()) == pytest.approx([100.0] * 3, abs=0.3)
    names = {path.name for path in (folder / "out").iterdir()}
    assert names == {"loops.png", "metrics.json", "loop-1.csv", "loop-2.csv", "loop-3.csv"}
    assert (folder / "out" / "loops.png").read_bytes().startswith(b"\x89PNG")
    numbers = json.loads((folder / "out" / "metrics.json").read_text())
    assert numbers["holds"] is True
    assert numbers["files"] == [str(each) for each in sines]
    assert numbers["model"] == str(model)
    table = hyst.read_record(folder / "out" / "loop-2.csv", input="drive", output="v", time=0)
    record = hyst.read_record(sines[1], input="drive", output="position", time="t")
    start, stop = numbers["records"][1]["valid"]
    assert table.output_unit == "um"
    np.testing.assert_array_equal(table.u, record.u[start:stop])
    # v is that of the plays, to the noise times the gain of the inverse, about 1.5; five of it.
    assert np.abs(table.y - FRONT(record.u)[start:stop]).max() < 5.0 * 0.015


def test_a_model_that_does_not_hold_ends_with_3(run: Run, model: Path, folder: Path) -> None:
    late = [write_sine(folder / f"late{f}.csv", f, stage(3)) for f in (4, 10, 25)]
    ended = run("loop", model, *late, *COLUMNS, "-o", "out")
    assert ended.code == 3
    assert ended.out.startswith("The model does not hold: the loops differ (3 loops of 4 to 25 Hz")
    assert "as a delay of" in ended.out
    assert "does that the model lacks" in ended.out
    assert (folder / "out" / "metrics.json").exists()
    tests = json.loads((folder / "out" / "metrics.json").read_text())["tests"]
    assert [each["cause"] for each in tests] == ["delay"]
    assert tests[0]["delay"] == pytest.approx(DT, rel=0.02)  # noise makes 0.004
    lenient = ("--tolerance", "50", "--force")
    assert run("loop", model, *late, *COLUMNS, "-o", "out", *lenient).code == 0


def test_one_record_is_drawn_and_not_tested(run: Run, model: Path, sines: list[Path]) -> None:
    ended = run("loop", model, sines[0], *COLUMNS, "-o", "out")
    assert ended.code == 0
    assert ended.out.startswith("Whether the loop depends on the rate was not tested: there is one")


def test_a_drive_that_does_not_repeat_is_drawn(run: Run, model: Path, folder: Path) -> None:
    u = hyst.signals.multisine(DT, 1000, amplitude=7.0).u
    t = np.arange(u.size) * DT
    path = write_csv(folder / "noise.csv", "t [s],drive [V],position [um]", t, u, stage()(u))
    ended = run("loop", model, path, *COLUMNS, "-o", "out")
    assert ended.code == 0
    assert "no input repeats" in ended.out
    assert "Loops by frequency" not in ended.out
    assert "note: the input of noise.csv goes from" in ended.err


def test_what_cannot_be_seen_is_refused(
    refused: Callable[..., str], model: Path, sines: list[Path], folder: Path
) -> None:
    FRONT.save("plays.json")
    k = np.arange(300)
    wave = np.sin(0.5 * k)
    short = write_csv(folder / "short.csv", "t,drive,position", *(k * DT, wave, wave))
    short.write_text("\n".join(short.read_text().splitlines()[:41]) + "\n")
    millimetres = write_csv(
        folder / "mm.csv", "t [s],drive [V],position [mm]", *(k * DT, wave, wave)
    )
    out = ("-o", "out")
    assert "no linear dynamics" in refused("loop", "plays.json", *sines, *COLUMNS, *out)
    assert "the inverse of the dynamics needs" in refused(
        "loop", model, "short.csv", *COLUMNS, *out
    )
    assert "'mm' but the model's in 'um'" in refused("loop", model, millimetres, *COLUMNS, *out)
    assert "dt = 0.0005 s" in refused(
        "loop", model, sines[0], "--input", "1", "--output", "2", "--rate", "2000", *out
    )
    assert "hold nothing above 500 Hz" in refused(
        "loop", model, sines[0], *COLUMNS, *out, "--band", "600"
    )
    assert "level" in refused("loop", model, *sines, *COLUMNS, *out, "--level", "0.9")
    (folder / "out").mkdir()
    (folder / "out" / "loop-1.csv").write_bytes(sines[0].read_bytes())
    assert "is one of the files to read" in refused(
        "loop", model, "out/loop-1.csv", *COLUMNS, "-o", "out", "--force"
    )

"""Records at several temperatures give a model over it, which the other verbs take."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import write_csv

import hyst
from reference import moving_plays

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

HEADER = "drive [V],position [um]"
COLUMNS = ["--input", "drive", "--output", "position", "--rate", 1000]
OVER = ["--schedule", "20,35,50", "--schedule-name", "temperature", "--schedule-unit", "degC"]

FAST = ["--plays", 3, "--delay", 0]


def write_record(path: Path, t: float, seed: int) -> Path:
    u = moving_plays.sweep(600)
    y = moving_plays.output(u, np.full(u.size, t))
    y = y + 0.002 * np.ptp(y) * np.random.default_rng(seed).normal(size=u.size)
    return write_csv(path, HEADER, u, y)


@pytest.fixture
def records(folder: Path) -> list[Path]:
    return [write_record(folder / f"at{t}.csv", t, i) for i, t in enumerate((20, 35, 50))]


def model_file(folder: Path) -> Path:
    models = []
    for t in (20.0, 50.0):
        of = moving_plays.actuator(t)
        plays = hyst.PrandtlIshlinskii(of.p, of.r, p0=of.p0)
        about = hyst.ModelDescription(input_unit="V", output_unit="um", input_low=-2, input_high=2)
        models.append((hyst.Affine(1.0, of.offset) @ plays).with_description(about))
    hyst.Scheduled(models, [20.0, 50.0], "temperature", "degC").save(folder / "model.json")
    return folder / "model.json"


def signals(
    folder: Path, unit: str = "degC", high: float = 49.0
) -> tuple[Path, np.ndarray, np.ndarray]:
    u, t = 0.5 * moving_plays.sweep(800), np.linspace(21.0, high, 800)
    y = moving_plays.output(u, t)
    path = write_csv(folder / "signals.csv", f"drive [V],wanted [um],temp [{unit}]", u, y, t)
    return path, u, y


def test_a_model_over_temperature_is_identified_and_used(
    records: list[Path], run: Callable, folder: Path
):
    between = write_record(folder / "between.csv", 27.5, 9)
    judged = ["--validate", between, "--validate-schedule", 27.5]
    ended = run(
        "identify", *records, *COLUMNS, *OVER, *judged, "--family", "pi", *FAST, "-o", "out"
    )
    assert ended.code == 0, ended.err
    assert "over temperature" in ended.out
    assert "temperature 27.5 degC, by straight lines from 20 to 35" in ended.out
    assert (folder / "out" / "at_35" / "report.html").stat().st_size > 0
    told = json.loads((folder / "out" / "metrics.json").read_text())
    assert told["schedule"] == {"name": "temperature", "unit": "degC", "values": [20, 35, 50]}
    assert told["held_out"][0]["rms_percent"] < 0.3
    found = hyst.load(folder / "out" / "model.json")
    assert isinstance(found, hyst.Scheduled)
    assert found.description.input_unit == "V"
    assert run("info", "out/model.json").code == 0


def test_simulation_and_command_follow_a_column(run: Callable, folder: Path):
    model = model_file(folder)
    path, u, y = signals(folder)
    at = ["--schedule-column", "temp"]
    assert run("simulate", model, path, "--input", "drive", *at, "-o", "y.csv").code == 0
    got = np.genfromtxt(folder / "y.csv", delimiter=",", names=True)
    # Equations in plain Python, some ten roundings; files have every digit.
    np.testing.assert_allclose(got[got.dtype.names[-1]], y, rtol=0, atol=1e-14)
    ended = run("compensate", model, path, "--column", "wanted", *at, "-o", "u.csv")
    assert ended.code == 0, ended.err
    assert "exact for the model" in ended.out
    command = np.genfromtxt(folder / "u.csv", delimiter=",", names=True)
    np.testing.assert_allclose(command["command_V"], u, rtol=0, atol=1e-14)
    one = run(
        "compensate", model, path, "--column", "wanted", "--schedule-value", 30, "-o", "v.csv"
    )
    assert one.code == 0
    assert run("export", model, "--inverse", "-o", "c").code == 0
    assert "stage_step(stage_state *state, double u, double s)" in (
        (folder / "c" / "stage.h").read_text()
    )
    assert run("export", model, "--schedule-value", 30, "--target", "c", "-o", "d").code == 0
    assert "double s)" not in (folder / "d" / "stage.h").read_text()


def test_outside_the_schedule_is_told(run: Callable, folder: Path):
    model, (path, _, _) = model_file(folder), signals(folder, high=70.0)
    at = ["--schedule-column", "temp"]
    ended = run("simulate", model, path, "--input", "drive", *at, "-o", "y.csv")
    assert ended.code == 0
    assert "outside 20 to 50" in ended.err
    ended = run("simulate", model, path, "--input", "drive", "--schedule-value", 99, "-o", "z.csv")
    assert "temperature = 99 is outside 20 to 50" in ended.err


def test_what_does_not_go_together_is_refused(records: list[Path], run: Callable, folder: Path):
    model, (path, _, _) = model_file(folder), signals(folder)
    simulate = ["simulate", model, path, "--input", "drive", "-o", "y.csv"]
    assert "give its column with --schedule-column" in run(*simulate).err
    both = ["--schedule-column", "temp", "--schedule-value", 30]
    assert run(*simulate, *both).code == 2
    signals(folder, unit="K")
    ended = run("simulate", model, path, "--input", "drive", *both[:2], "-o", "y.csv")
    assert "temperature is in 'K' but the model's in 'degC'" in ended.err
    signals(folder)
    plain = folder / "plain.json"
    hyst.Affine(2.0).save(plain)
    ended = run("simulate", plain, path, "--input", "drive", *both[:2], "-o", "y.csv")
    assert "follows no second signal" in ended.err
    command = ["compensate", model, path, "--column", "wanted", *both[:2], "-o", "u.csv"]
    assert "--outside is for models" in run(*command, "--outside", "clip").err
    assert "outside -0.1 to 0.1" in run(*command, "--limits", "-0.1,0.1").err
    identify = ["identify", *records, *COLUMNS, "-o", "out"]
    assert "give it too" in run(*identify, "--schedule-name", "temperature").err
    assert "3 record(s) but 2 values" in run(*identify, "--schedule", "20,35").err
    assert "--lag is not for --schedule" in run(*identify, *OVER, "--lag", "auto").err
    assert "--creep is not for --schedule" in run(*identify, *OVER, "--creep", "2").err
    ended = run(*identify, *OVER, "--validate", records[0])
    assert "--validate-schedule belong together" in ended.err
    assert run("export", model, "--target", "fmu", "-o", "x.fmu").code == 2


def test_an_export_with_limits_and_a_start(run: Callable, folder: Path):
    model = model_file(folder)
    drive = ["--inverse", "--limits=-0.5,0.75", "--history", "0.75,-0.5"]
    ended = run("export", model, *drive, "--history-at", 30, "-o", "out")
    assert ended.code == 0, ended.err
    assert "after 0.75, -0.5; or stage_init_after" in ended.out
    said = (folder / "out" / "README.md").read_text()
    assert "| start | after drives of 0.75, -0.5 V at temperature 30 degC |" in said
    for more, why in (
        ([], "needs its value meanwhile"),
        (["--history-at", 99], "history_at is 99, outside 20 to 50"),
        (["--history-at", 30, "--schedule-value", 30], "follows no second signal"),
        (["--history-at", 30, "--target", "fmu"], "--history-at"),
    ):
        ended = run("export", model, *drive, *more, "-o", "none")
        assert ended.code == 2
        assert why in ended.err
        assert not (folder / "none").exists()

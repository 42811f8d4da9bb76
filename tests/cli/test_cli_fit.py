"""hyst fit: a model file and a record give the model file of other constants, and a report."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import drive, snapshot, write_csv

import hyst

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

COLUMNS = ["--input", "u", "--output", "y", "--rate", 1000]
DYNAMICS = hyst.LinearDynamics.from_transfer_function([0.2], [1.0, -0.8], dt=1e-3)
TRUE = DYNAMICS @ hyst.PrandtlIshlinskii([0.4, 0.2], [1.0, 3.0], p0=0.8)
GUESS = DYNAMICS @ hyst.PrandtlIshlinskii([0.3, 0.3], [1.2, 2.5], p0=1.0)


@pytest.fixture
def files(folder: Path) -> tuple[Path, Path]:
    u = drive()
    record = write_csv(folder / "record.csv", "u,y", u, TRUE(u))
    model = folder / "guess.json"
    GUESS.save(model)
    return model, record


def test_constants_are_fitted_and_written(files: tuple[Path, Path], run: Callable, folder: Path):
    model, record = files
    ended = run("fit", model, record, *COLUMNS, "--free", "prandtl_ishlinskii", "-o", "out")
    assert ended.code == 0
    assert "prandtl_ishlinskii.p[1]" in ended.out
    assert "composition" in ended.out or "model of" in ended.out
    found = hyst.load(folder / "out" / "model.json")
    np.testing.assert_allclose(
        found.parameters().values, TRUE.parameters().values, rtol=1e-6, atol=1e-6
    )
    assert found.description.provenance.options["free"] == ["prandtl_ishlinskii"]
    told = json.loads((folder / "out" / "metrics.json").read_text())
    assert [each["name"] for each in told["parameters"]] == list(GUESS.parameters().names[:5])
    assert (folder / "out" / "report.html").stat().st_size > 0


def test_dynamics_are_fitted_as_a_whole_and_told_by_what_they_do(
    files: tuple[Path, Path], run: Callable, folder: Path
):
    model, record = files
    ended = run("fit", model, record, *COLUMNS, "-o", "out")
    assert ended.code == 0
    assert "the gain of linear_dynamics at rest is held at 1" in ended.out
    assert "not determined" not in ended.out
    lines = [line.split() for line in ended.out.split("\n")]
    told = next(line for line in lines if line[:1] == ["linear_dynamics.time_constant[1]"])
    # A pole at 0.8 forgets within -dt / log 0.8; six digits are printed.
    assert float(told[1]) == pytest.approx(-1e-3 / np.log(0.8), rel=1e-5)
    found = hyst.load(folder / "out" / "model.json")
    u = drive()
    np.testing.assert_allclose(found(u), TRUE(u), atol=1e-6)
    assert "time_constant" in (folder / "out" / "report.html").read_text()


def test_what_is_not_determined_has_a_dash_and_a_reason(run: Callable, folder: Path):
    true = hyst.Affine(2.0) @ hyst.PrandtlIshlinskii([0.4, 0.2], [1.0, 3.0], p0=0.8)
    record = write_csv(folder / "static.csv", "u,y", drive(), true(drive()))
    model = folder / "two_gains.json"
    (hyst.Affine(2.0) @ GUESS.parts[0]).save(model)
    ended = run("fit", model, record, *COLUMNS, "-o", "out")
    assert ended.code == 0
    assert "on a bound, or not determined by the records" in ended.out
    assert "do not tell apart" in ended.out
    assert any(
        line.split()[::2] == ["prandtl_ishlinskii.p0", "-"] for line in ended.out.split("\n")
    )
    page = (folder / "out" / "report.html").read_text()
    assert "A dash: on a bound, or not determined by the records" in page
    assert not hyst.load(folder / "out" / "model.json").description.provenance.options


def test_a_delay_counted_in_other_samples_is_refused(
    files: tuple[Path, Path], run: Callable, folder: Path
):
    _, record = files
    plays = hyst.PrandtlIshlinskii([0.4], [1.0], p0=0.8)
    about = hyst.operators.ModelDescription(dt=5e-3, delay=4)
    plays.with_description(about).save(folder / "late.json")
    ended = run("fit", folder / "late.json", record, *COLUMNS, "-o", "out")
    assert ended.code == 2
    assert "4 samples of 0.005 s, the record's are of 0.001 s; give --delay" in ended.err
    ended = run("fit", folder / "late.json", record, *COLUMNS, "--delay", 20, "-o", "out")
    # The delay is taken, and the record has dynamics and no such delay: the verdict says so.
    assert ended.code == 3
    assert ended.out.startswith("verdict: unfit")
    assert hyst.load(folder / "out" / "model.json").description.delay == 20


def test_bounds_and_validation(files: tuple[Path, Path], run: Callable, folder: Path):
    model, record = files
    bound = ["--bound", "prandtl_ishlinskii.p0=0.9,2", "--free", "prandtl_ishlinskii"]
    ended = run("fit", model, record, *COLUMNS, *bound, "--validate", record, "-o", "out")
    assert ended.code == 0
    assert "validation" in ended.out
    assert hyst.load(folder / "out" / "model.json").parameters().values[0] == 0.9


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--free", "zz"], "no constant 'zz'"),
        (["--bound", "x"], "--bound is 'x'; give a name and two numbers"),
        (["--bound", "prandtl_ishlinskii.p0=3,4"], "outside its bounds 3 to 4"),
        (["--delay", "-9999"], "delay is -9999"),
        (["--plays", "3"], "--plays"),
    ],
)
def test_what_cannot_be_used_is_refused(
    files: tuple[Path, Path], refused: Callable, folder: Path, arguments: list[str], said: str
):
    model, record = files
    before = snapshot(folder)
    assert said in refused("fit", model, record, *COLUMNS, *arguments, "-o", "out")
    assert snapshot(folder) == before


def test_a_record_in_another_unit_or_rate_is_refused(
    files: tuple[Path, Path], refused: Callable, folder: Path
):
    model, record = files
    at_another_rate = ["--input", "u", "--output", "y", "--rate", 500]
    assert "the model 0.001 s" in refused("fit", model, record, *at_another_rate, "-o", "out")
    described = folder / "volts.json"
    GUESS.save(described, hyst.ModelDescription(input_unit="V"))
    label = ["--input-label", "drive [mm]"]
    told = refused("fit", described, record, *COLUMNS, *label, "-o", "out")
    assert "is in 'mm' but the model's in 'V'" in told

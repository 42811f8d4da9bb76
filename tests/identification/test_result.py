"""What a result tells: errors by record, outputs at any delay, the verdict first."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst
from hyst.identification import Identified
from hyst.operators import Verdict


@pytest.fixture(scope="module")
def pair() -> tuple[hyst.Record, hyst.Record]:
    """Two records, of which the second has a gain larger by half."""
    first = record(TRUE_PI, drive(seed=1), 0.01, seed=1)
    second = record(TRUE_PI, drive(seed=2), 0.01, seed=2)
    return first, replace(second, y=1.5 * second.y)


@pytest.fixture(scope="module")
def found(pair: tuple[hyst.Record, hyst.Record]) -> Identified:
    return hyst.identify(pair, family="pi", plays=2, delay=0, start=0)


def test_errors_by_record_are_those_of_each(
    found: Identified, pair: tuple[hyst.Record, hyst.Record]
) -> None:
    for number, (each, own) in enumerate(zip(found.per_record, pair, strict=True), 1):
        error = found.model(own.u) - own.y
        assert (each.number, each.samples) == (number, len(own))
        assert each.metrics is not None
        # The same sums in another order.
        assert each.metrics.rms == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-12)
        assert each.metrics.max_abs == pytest.approx(np.abs(error).max(), rel=1e-12)
        assert each.metrics.output_range == np.ptp(own.y)
    squares = [each.samples * each.metrics.rms**2 for each in found.per_record if each.metrics]
    whole = found.metrics["training"]
    assert sum(squares) == pytest.approx(whole.samples * whole.rms**2, rel=1e-12)


def test_the_summary_has_a_line_for_each(found: Identified) -> None:
    lines = found.summary().splitlines()
    for each in found.per_record:
        assert each.metrics is not None
        told = [line for line in lines if line.startswith(f"record {each.number} ")]
        assert len(told) == 1
        assert f"rms {each.metrics.rms:.4g} (" in told[0]
        assert f"{each.samples} samples" in told[0]


def test_records_that_agree_have_errors_of_their_noise() -> None:
    both = [record(TRUE_PI, drive(seed=s), 0.01, seed=s) for s in (1, 2)]
    found = hyst.identify(both, family="pi", plays=3, delay=0)
    for each in found.per_record:
        assert each.metrics is not None
        # The noise is 0.01; over hundreds of samples its rms is within some percent.
        assert each.metrics.rms == pytest.approx(0.01, rel=0.15)


def test_the_verdict_comes_first(found: Identified) -> None:
    unfit = replace(found, verdict=Verdict("unfit", ("Two actuators.", "Identify each.")))
    assert unfit.summary().startswith("verdict: unfit - Two actuators.\n  Identify each.\n")
    assert repr(unfit).startswith("Identified(unfit: 'Two actuators.'; pi, ")
    assert "array" not in repr(unfit)
    told = unfit.to_dict()
    assert next(iter(told)) == "verdict"
    assert told["verdict"] == {"level": "unfit", "sentences": ["Two actuators.", "Identify each."]}
    assert told["delay_interval"] == [0, 0]
    assert told["findings"] == unfit.diagnosis.to_dict()["findings"]
    assert json.loads(json.dumps(told, allow_nan=False)) == told


def test_the_model_carries_verdict_and_interval(found: Identified) -> None:
    about = found.model.description
    assert about == found.description
    assert about.verdict == found.verdict
    assert about.delay_interval == found.delay_interval
    assert type(about.delay) is int


def test_the_smallest_swing_is_that_of_the_record() -> None:
    corners = np.array([0.0, 4.0, 0.5, 3.0, 2.0, 4.0, 0.0, 4.0])
    u = np.interp(np.arange(0.0, 7.0, 0.01), np.arange(8.0), corners)
    stage = hyst.PrandtlIshlinskii([0.5], [0.3], p0=1.0)
    found = hyst.identify(hyst.Record(u, stage(u), 0.01), family="pi", plays=1, delay=0)
    assert found.description.smallest_swing == pytest.approx(1.0, abs=0.05)  # from 3 to 2


@pytest.mark.parametrize("delay", [3, 1.25, 0.0, -2, -0.5])
def test_predictions_come_later_by_any_delay(found: Identified, delay: float) -> None:
    # A slow drive: between samples the output of plays moves on a line nearly everywhere.
    t = np.arange(2000.0)
    u = 3.0 * np.sin(t / 150.0)
    late = replace(found, delay=delay).predict(u)
    expected = found.model(3.0 * np.sin((np.arange(-10.0, 2010.0) - delay) / 150.0))[10:-10]
    inside = slice(20, -20)
    # A sample of delay would be an error of 3 / 150 times the slope; a corner costs a part of it.
    assert late[inside] == pytest.approx(expected[inside], abs=2e-3)
    if float(delay).is_integer() and delay > 0:
        assert np.array_equal(late[int(delay) :], found.model(u)[: -int(delay)])
        assert (late[: int(delay)] == found.model(u)[0]).all()

"""The delay is told apart from hysteresis, asymmetry, drift and noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst
from hyst.identification.choice.delay import find_delay, usable_delay
from hyst.identification.record_use.used_samples import prepare

ASYMMETRIC = hyst.ModifiedPrandtlIshlinskii(
    TRUE_PI, hyst.DeadZone([1.0, -0.4, 0.5], [0, 0.3, -0.5])
)


def estimate(*records: hyst.Record) -> float:
    data = prepare(records, "auto", 0)
    return usable_delay(find_delay(data), data)


@pytest.mark.parametrize("model", [TRUE_PI, ASYMMETRIC, hyst.Affine(2.0, 1.0)])
@pytest.mark.parametrize("delay", [0, 2, 4, 9])
def test_finds_the_delay(model: hyst.Operator, delay: int) -> None:
    assert estimate(record(model, delay=delay)) == delay


@pytest.mark.parametrize("model", [TRUE_PI, ASYMMETRIC, hyst.Affine(2.0, 1.0)])
@pytest.mark.parametrize("delay", [0, 2, 4, 9])
def test_finds_the_delay_in_noise_with_an_interval(model: hyst.Operator, delay: int) -> None:
    """With 2 % of noise parts of a sample are told to half of one, and 0 is told as 0."""
    data = prepare(record(model, noise=0.02, delay=delay), "auto", 0)
    evidence = find_delay(data)
    assert evidence.low <= delay <= evidence.high
    assert usable_delay(evidence, data) == pytest.approx(delay, abs=0.5 if delay else 0.0)


def test_drift_does_not_pass_for_delay() -> None:
    given = record(TRUE_PI, noise=0.005, delay=2)
    drifting = hyst.Record(given.u, given.y + np.linspace(0.0, 0.3, len(given)), given.dt)
    assert estimate(drifting) == 2


def test_two_records_share_one_delay() -> None:
    assert estimate(*[record(TRUE_PI, drive(seed=s), 0.01, delay=3, seed=s) for s in (1, 2)]) == 3


def test_a_sample_that_noise_may_hide_is_no_delay_but_possible() -> None:
    for delay in (0, 1):
        evidence = find_delay(prepare(record(TRUE_PI, noise=0.02, delay=delay), "auto", 0))
        assert evidence.low <= delay <= evidence.high
        assert evidence.delay == (0.0 if evidence.low <= 0.0 else delay)


@pytest.mark.parametrize(("told", "used"), [(1000.0, 250), (-1000.0, -250), (3.25, 3.25)])
def test_a_delay_leaves_half_of_the_record(told: float, used: float) -> None:
    data = prepare(record(TRUE_PI, noise=0.005, delay=9).slice(0, 600), 100, 0)
    assert usable_delay(replace(find_delay(data), delay=told), data) == used


def test_an_output_ahead_gives_a_negative_delay() -> None:
    late = record(TRUE_PI, noise=0.005)
    ahead = hyst.Record(late.u[:-5], late.y[5:], late.dt)
    assert estimate(ahead) == -5.0

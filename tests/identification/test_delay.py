"""The delay is told apart from hysteresis, asymmetry, drift and noise, to a part of a sample."""

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
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_finds_the_delay(model: hyst.Operator, delay: int, noise: float) -> None:
    # Noise of 0.02 hides parts of a sample, and never half of one.
    assert estimate(record(model, noise=noise, delay=delay)) == pytest.approx(delay, abs=0.5)
    if noise == 0.0 or delay == 0:
        assert estimate(record(model, noise=noise, delay=delay)) == delay


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


def test_a_delay_leaves_half_of_the_record() -> None:
    data = prepare(record(TRUE_PI, noise=0.005, delay=9).slice(0, 600), 100, 0)
    assert usable_delay(replace(find_delay(data), delay=1000.0), data) == 250


def test_an_output_ahead_gives_a_negative_delay() -> None:
    late = record(TRUE_PI, noise=0.005)
    ahead = hyst.Record(late.u[:-5], late.y[5:], late.dt)
    data = prepare(ahead, "auto", 0)
    evidence = find_delay(data)
    assert evidence.delay == -5.0
    assert usable_delay(evidence, data) == -5

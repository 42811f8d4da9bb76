"""The delay is told apart from hysteresis, asymmetry, drift and noise, in whole samples."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst
from hyst.identification.choice.delay import find_delay, whole_delay
from hyst.identification.record_use.used_samples import prepare

ASYMMETRIC = hyst.ModifiedPrandtlIshlinskii(
    TRUE_PI, hyst.DeadZone([1.0, -0.4, 0.5], [0, 0.3, -0.5])
)


def estimate(*records: hyst.Record) -> int:
    data = prepare(records, "auto", 0)
    return whole_delay(find_delay(data), data)


@pytest.mark.parametrize("model", [TRUE_PI, ASYMMETRIC, hyst.Affine(2.0, 1.0)])
@pytest.mark.parametrize("delay", [0, 1, 4, 9])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_finds_the_delay(model: hyst.Operator, delay: int, noise: float) -> None:
    assert estimate(record(model, noise=noise, delay=delay)) == delay


def test_drift_does_not_pass_for_delay() -> None:
    given = record(TRUE_PI, noise=0.005, delay=2)
    drifting = hyst.Record(given.u, given.y + np.linspace(0.0, 0.3, len(given)), given.dt)
    assert estimate(drifting) == 2


def test_two_records_share_one_delay() -> None:
    assert estimate(*[record(TRUE_PI, drive(seed=s), 0.01, delay=3, seed=s) for s in (1, 2)]) == 3


def test_a_delay_leaves_half_of_the_shortest_record() -> None:
    given = record(TRUE_PI, noise=0.005, delay=9)
    data = prepare(given, "auto", 0)
    short = prepare((given, given.slice(0, 16)), 0, 0)
    assert whole_delay(find_delay(data), short) == 8


def test_an_output_ahead_gives_no_negative_delay_to_a_model() -> None:
    late = record(TRUE_PI, noise=0.005)
    ahead = hyst.Record(late.u[:-5], late.y[5:], late.dt)
    data = prepare(ahead, "auto", 0)
    evidence = find_delay(data)
    assert evidence.delay == -5.0
    assert whole_delay(evidence, data) == 0

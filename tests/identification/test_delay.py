"""The delay is told apart from hysteresis, asymmetry and noise."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst
from hyst.identification.choice.delay import estimate_delay
from hyst.identification.record_use.used_samples import prepare

ASYMMETRIC = hyst.ModifiedPrandtlIshlinskii(
    TRUE_PI, hyst.DeadZone([1.0, -0.4, 0.5], [0, 0.3, -0.5])
)


@pytest.mark.parametrize("model", [TRUE_PI, ASYMMETRIC, hyst.Affine(2.0, 1.0)])
@pytest.mark.parametrize("delay", [0, 1, 4, 9])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_finds_the_delay(model: hyst.Operator, delay: int, noise: float) -> None:
    given = record(model, noise=noise, delay=delay)
    assert estimate_delay(prepare(given, "auto", 0)) == delay


def test_drift_does_not_pass_for_delay() -> None:
    given = record(TRUE_PI, noise=0.005, delay=2)
    drifting = hyst.Record(given.u, given.y + np.linspace(0.0, 0.3, len(given)), given.dt)
    assert estimate_delay(prepare(drifting, "auto", 0)) == 2


def test_two_records_share_one_delay() -> None:
    both = [record(TRUE_PI, drive(seed=s), 0.01, delay=3, seed=s) for s in (1, 2)]
    assert estimate_delay(prepare(both, "auto", 0)) == 3

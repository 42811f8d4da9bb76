"""Loops that differ with their rate, and those that do not."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    DT,
    Actuator,
    Array,
    bent,
    friction,
    plays,
    record,
    sine,
    switching,
    triangle,
    warned,
)

import hyst


def growing(u: Array, share: float) -> Array:
    """Plays whose radii grow by a share for every factor of ten of the rate."""
    rate = float(np.median(np.abs(np.diff(u)))) / DT
    scale = 1.0 + share * np.log10(rate / 200.0)
    return scale * plays(u / scale)


def late(y: Array, time_constant: float) -> Array:
    """First-order lag, exact for an output that is held between samples."""
    keep = np.exp(-DT / time_constant)
    result, state = [], y[0]
    for value in y.tolist():
        state = keep * state + (1.0 - keep) * value
        result.append(state)
    return np.array(result)


@pytest.mark.parametrize("drive", [triangle, sine])
def test_records_at_several_rates(drive: object) -> None:
    inputs = [drive(period, round(3 * period)) for period in (2000, 500, 100)]  # type: ignore[operator]
    records = [record(u, growing(u, 0.5), 0.05) for u in inputs]
    (found,) = hyst.diagnose(records).named("rate dependence")
    assert "rdpi" in found.advice
    assert found.amounts["fastest"] == pytest.approx(20.0 * found.amounts["slowest"], rel=0.02)
    # A dependence on the logarithm is no lag, which the middle record shows.
    assert "lag" not in found.amounts


def test_one_record_at_several_rates() -> None:
    parts = [triangle(1000.0, 2000), triangle(300.0, 1500), triangle(100.0, 1000)]
    y = np.concatenate([growing(u, 0.5) for u in parts])
    assert "rate dependence" in warned(record(np.concatenate(parts), y, 0.05))


def test_a_lag_is_told_as_one_with_its_time() -> None:
    inputs = [sine(period, round(3 * period)) for period in (1000, 300, 100)]
    records = [record(u, late(plays(u), 2e-3), 0.03) for u in inputs]
    (found,) = hyst.diagnose(records).named("rate dependence")
    # A held input lags by half a sample less: tau - dt / 2 = 1.5 ms.
    assert found.amounts["lag"] == pytest.approx(1.5e-3, rel=0.1)
    assert "hammerstein" in found.advice


@pytest.mark.parametrize("actuator", [plays, bent, switching, friction])
@pytest.mark.parametrize("noise", [0.0, 0.2])
def test_rate_independent_actuators_are_none(actuator: Actuator, noise: float) -> None:
    inputs = [sine(period, round(3 * period)) for period in (1000, 300, 50)]
    records = [record(u, actuator(u), noise, seed) for seed, u in enumerate(inputs)]
    assert "rate dependence" not in warned(records)
    whole = np.concatenate(inputs)
    assert "rate dependence" not in warned(record(whole, actuator(whole), noise))

"""Drift of the output, told with its size where the memory returns, and not elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    DT,
    NESTED,
    Actuator,
    Array,
    bent,
    plays,
    record,
    sine,
    switching,
    through,
    triangle,
    warned,
)

import hyst


def drift_of(records: hyst.Record) -> hyst.diagnosis.Finding:
    """The one drift that is told."""
    (found,) = hyst.diagnose(records).named("drift")
    return found


@pytest.mark.parametrize("rate", [1.5, -0.25])
@pytest.mark.parametrize(
    ("u", "actuator"),
    [
        (triangle(), plays),
        (through(NESTED), bent),
        (sine(1000.0 / 3.0), switching),
        (triangle(1000.0, 2001), plays),
        (sine(400.0, 4000, -50.0, 50.0), bent),
    ],
    ids=["triangle", "nested", "333.33", "two cycles", "bipolar"],
)
def test_even_drift_has_its_rate(u: Array, actuator: Actuator, rate: float) -> None:
    t = np.arange(u.size) * DT
    found = drift_of(record(u, actuator(u) + rate * t, 0.02))
    # Means of 250 samples and more have errors of 0.001 um over one second at least.
    assert found.amounts["rate"] == pytest.approx(rate, abs=0.01)
    assert found.amounts["total"] == pytest.approx(rate * t[-1], abs=0.03)
    assert found.severity == "warning"
    assert f"{found.amounts['rate']:.3g} um/s" in found.sentence


def test_creep_is_told_to_slow_down() -> None:
    u = triangle(250.0, 8000)
    t = np.arange(u.size) * DT
    found = drift_of(record(u, plays(u) + 1.5 * np.log10(1.0 + t / 0.05), 0.05))
    # From 0.4 s on, by which the first cycles are over, log10 rises by 1.2 per 7.6 s.
    assert 0.5 * 1.8 / 7.6 < found.amounts["rate"] < 2.0 * 1.8 / 7.6
    assert found.amounts["early"] > 1.5 * found.amounts["late"] > 0.0
    assert "not even" in found.sentence


@pytest.mark.parametrize(
    "u",
    [
        through([0.0, 100.0, 0.0]),
        hyst.signals.decaying_triangle(DT, 50.0, 200.0, cycles=10).u,
        through([0.0, *np.random.default_rng(8).uniform(0.0, 100.0, 12)]),
    ],
    ids=["one loop", "decaying", "random"],
)
def test_without_return_nothing_is_claimed(u: Array) -> None:
    t = np.arange(u.size) * DT
    assert "drift" not in warned(record(u, plays(u) + 2.0 * t, 0.05))


def test_rate_dependence_and_a_random_walk_are_no_drift() -> None:
    u = 50.0 + 50.0 * np.sin(2.0 * np.pi * np.cumsum(np.geomspace(1.0, 20.0, 6000)) * DT)
    assert "drift" not in warned(record(u, bent(u)))
    walk = np.cumsum(0.001 * np.random.default_rng(4).standard_normal(4000))
    # 0.06 um in the end, less than the noise.
    assert "drift" not in warned(record(triangle(), plays(triangle()) + walk, 0.2))


def test_drift_too_small_to_matter_is_not_told() -> None:
    u = triangle()
    # 0.016 um over the record: a fortieth of a percent of the range, half the noise.
    y = plays(u) + 0.004 * np.arange(u.size) * DT
    assert "drift" not in warned(record(u, y, 0.03))


@pytest.mark.parametrize("seed", [3, 4, 5])
@pytest.mark.parametrize("pole", [0.4, 0.9])
def test_a_drive_that_nearly_repeats_makes_no_drift_of_dynamics(seed: int, pole: float) -> None:
    """Lines 136 and 137 bins apart by turns: after 44.02 samples the drive is nearly the same."""
    lines = np.linspace(1, 2999, 23).astype(int)
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, lines.size)
    k = np.arange(12_000)[:, None]
    u = np.cos(2.0 * np.pi * k * lines / 6000.0 + phases).sum(axis=1)
    y, state = np.empty(u.size), 0.0
    for n, each in enumerate(u):
        state = pole * state + (1.0 - pole) * each
        y[n] = state
    assert not hyst.diagnose(record(u, y)).named("drift")

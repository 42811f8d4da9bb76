"""Hum and other sines in the output, also where they stand still against the drive."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    DT,
    NESTED,
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


@pytest.mark.parametrize(
    ("frequency", "amplitude", "phase"),
    [(50.0, 0.8, 0.0), (50.0, 0.8, 2.0), (60.0, 0.2, 1.0), (49.97, 0.5, 1.0), (47.3, 0.3, 0.0)],
)
@pytest.mark.parametrize(
    "u", [triangle(), through(NESTED), sine()], ids=["triangle", "nested", "sine"]
)
def test_line_has_its_frequency_and_amplitude(
    u: Array, frequency: float, amplitude: float, phase: float
) -> None:
    t = np.arange(u.size) * DT
    y = plays(u) + amplitude * np.sin(2.0 * np.pi * frequency * t + phase)
    (found,) = hyst.diagnose(record(u, y, 0.03)).named("foreign line")
    # A record of 4 s resolves 0.25 Hz; of the sine, what is smooth in a branch took some percent.
    assert found.amounts["frequency"] == pytest.approx(frequency, abs=0.02)
    assert found.amounts["amplitude"] == pytest.approx(amplitude, rel=0.1)
    assert ("the mains" in found.sentence) == (frequency != 47.3)


def test_hum_in_one_loop_from_rest() -> None:
    u = through([0.0, 100.0, 0.0], 2000)
    y = plays(u) + 0.5 * np.sin(2.0 * np.pi * 50.0 * np.arange(u.size) * DT)
    (found,) = hyst.diagnose(record(u, y, 0.05)).named("foreign line")
    assert found.amounts["frequency"] == pytest.approx(50.0, abs=0.02)


def test_what_the_drive_has_is_not_foreign() -> None:
    u = triangle()
    u = u + 0.8 * np.sin(2.0 * np.pi * 50.0 * np.arange(u.size) * DT)
    assert "foreign line" not in warned(record(u, plays(u), 0.02))
    stairs = hyst.signals.staircase(DT, 0.0, 100.0, 1000.0, steps=10, hold=0.1).u
    for actuator in (plays, bent, switching):
        assert "foreign line" not in warned(record(stairs, actuator(stairs), 0.02))


def test_ringing_of_a_resonance_at_the_corners_is_no_line() -> None:
    u = triangle(500.0, 5000)
    t = np.arange(500) * DT
    # Poles at 60 Hz with a damping of 0.1, excited by the corners: over long before the next one.
    ringing = 2.0 * np.exp(-0.1 * 377.0 * t) * np.sin(377.0 * t)
    y = plays(u) + np.tile(ringing, 10)
    assert "foreign line" not in warned(record(u, y, 0.02))


@pytest.mark.parametrize("period", [7.3, 9.1, 12.7, 21.37])
@pytest.mark.parametrize("unit", [1.0, 2.0**7])
def test_harmonics_folded_by_few_samples_are_the_drives(period: float, unit: float) -> None:
    t = np.arange(1500)
    u = 50.0 + 50.0 * np.sin(2.0 * np.pi * t / period)
    noise = 0.02 * np.random.default_rng(3).standard_normal(t.size)
    assert not hyst.diagnose(record(u, unit * (plays(u) + noise))).named("foreign line")
    hum = 0.5 * np.sin(2.0 * np.pi * 50.0 * t * DT)
    (found,) = hyst.diagnose(record(u, unit * (plays(u) + noise + hum))).named("foreign line")
    assert found.amounts["frequency"] == pytest.approx(50.0, abs=0.05)


@pytest.mark.parametrize(("slow", "fast"), [(3.1, 50.0), (4.3, 60.0)])
def test_a_tone_of_the_drive_modulated_by_its_loop_is_the_drives(slow: float, fast: float) -> None:
    t = np.arange(4000) * DT
    u = 45.0 * np.sin(2.0 * np.pi * slow * t) + np.sin(2.0 * np.pi * fast * t + 0.3)
    assert "foreign line" not in warned(record(u, plays(u), 0.02))

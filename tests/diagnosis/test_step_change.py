"""A gain or an offset that changes once."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    DT,
    NESTED,
    bent,
    plays,
    record,
    sine,
    through,
    triangle,
    warned,
)

import hyst


@pytest.mark.parametrize(("factor", "at"), [(1.05, 2100), (0.9, 1700)])
@pytest.mark.parametrize("drive", [triangle, sine])
def test_gain_and_its_sample(drive: object, factor: float, at: int) -> None:
    u = drive()  # type: ignore[operator]
    y = plays(u) * np.where(np.arange(u.size) < at, 1.0, factor)
    (found,) = hyst.diagnose(record(u, y, 0.1)).named("step change")
    assert found.amounts["gain"] == pytest.approx(factor - 1.0, abs=0.01)
    # Told to a quarter of a period.
    assert int(found.samples[0]) == pytest.approx(at, abs=125)


def test_offset_and_its_sample_and_no_drift_beside_it() -> None:
    u = triangle()
    y = plays(u) + 0.6 * (np.arange(u.size) >= 1300)
    found = hyst.diagnose(record(u, y, 0.1))
    (step,) = found.named("step change")
    assert step.amounts["offset"] == pytest.approx(0.6, abs=0.06)
    assert int(step.samples[0]) == pytest.approx(1300, abs=125)
    assert not found.named("drift")


def test_two_actuators_one_after_the_other() -> None:
    u = through(NESTED)
    y = np.concatenate([plays(u), plays(u, 0.55, (0.12, 0.05, 0.02))])
    (found,) = hyst.diagnose(record(np.concatenate([u, u]), y, 0.05)).named("step change")
    # Gains of the two: 0.55 and the plays' share against 0.5 and theirs.
    assert found.amounts["gain"] == pytest.approx(0.1, abs=0.03)
    assert int(found.samples[0]) == pytest.approx(u.size, abs=250)


def test_even_drift_and_slow_change_are_no_step() -> None:
    u = triangle()
    t = np.arange(u.size) * DT
    assert "step change" not in warned(record(u, bent(u) + 1.5 * t, 0.05))
    assert "step change" not in warned(record(u, plays(u) * (1.0 + 0.01 * t), 0.05))


@pytest.mark.parametrize("lost", [0.0, None])
def test_a_sensor_that_is_lost_for_a_while_changes_no_gain(lost: float | None) -> None:
    u = triangle(500.0, 4000)
    y = plays(u)
    y[1000:1300] = y[999] if lost is None else lost
    (found,) = hyst.diagnose(record(u, y, 0.02)).named("step change")
    assert "stops following the input" in found.sentence
    assert "stays there" not in found.sentence
    # A comparison takes a quarter of a period, and the step is put between two of them.
    assert abs(int(found.samples[0]) - 1000) <= 125

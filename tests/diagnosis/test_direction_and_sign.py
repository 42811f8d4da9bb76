"""Which way round a loop is run, and which sign the gain has."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    NESTED,
    bent,
    friction,
    plays,
    record,
    sine,
    switching,
    through,
    triangle,
    warned,
)

import hyst


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_exchanged_columns_run_the_wrong_way_round(sign: float) -> None:
    u = triangle()
    (found,) = hyst.diagnose(record(sign * plays(u), u, 0.05)).named("run direction")
    assert found.severity == "warning"
    assert "exchanged" in found.advice


def test_an_input_that_was_recorded_late() -> None:
    u = through(NESTED)
    found = hyst.diagnose(record(u[:-12], plays(u)[12:], 0.02)).named("run direction")
    assert "not recorded at the same time" in found[0].advice


@pytest.mark.parametrize("actuator", [plays, bent, switching])
def test_actuators_that_lag_are_right(actuator: object) -> None:
    for u in (triangle(), sine(400.7, 4000, -50.0, 50.0), through(NESTED)):
        y = actuator(u)  # type: ignore[operator]
        assert "run direction" not in warned(record(u, y, 0.02))
        assert "run direction" not in warned(record(u, 30.0 - y, 0.02))


def test_friction_is_told_both_ways_and_forces_are_believed() -> None:
    u = triangle()
    (micrometres,) = hyst.diagnose(record(u, friction(u))).named("run direction")
    assert micrometres.severity == "warning"
    assert "friction" in micrometres.advice
    newtons = record(u, friction(u), input_unit="mm", output_unit="N")
    (force,) = hyst.diagnose(newtons).named("run direction")
    assert force.severity == "remark"


@pytest.mark.parametrize("offset", [0.0, 100.0])
def test_negative_gain_is_remarked_with_its_size(offset: float) -> None:
    u = triangle()
    (found,) = hyst.diagnose(record(u, offset - plays(u), 0.02)).named("sign")
    # Of the line through the inner loop: 0.5 of the line, 0.19 of plays less what radii take.
    assert -0.69 < found.amounts["gain"] < -0.5
    assert found.severity == "remark"
    assert not hyst.diagnose(record(u, plays(u), 0.02)).named("sign")


def test_a_loop_without_slope_has_no_sign() -> None:
    u = sine(400.0, 2000, -50.0, 50.0)
    side = np.where(np.gradient(u) > 0.0, 1.0, -1.0)
    assert not hyst.diagnose(record(u, side, 0.01)).named("sign")

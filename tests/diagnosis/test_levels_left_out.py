"""A drive of two levels shows nothing between them, and no model of it is good."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import DT, Array, plays, record, sine, triangle, warned

import hyst

NAME = "levels left out"


def two_levels(seed: int, unit: float = 1.0) -> Array:
    chosen = np.random.default_rng(seed).choice([0.0, 100.0], 100)
    return unit * np.repeat(chosen, 40)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("unit", [1.0, 2.0**-12])
def test_what_lies_between_two_levels_is_named(seed: int, unit: float) -> None:
    u = two_levels(seed)
    (found,) = hyst.diagnose(record(unit * u, plays(u), 0.02)).named(NAME)
    assert (found.amounts["low"], found.amounts["high"]) == (0.0, unit * 100.0)
    assert found.amounts["share"] == 1.0


def test_a_square_wave_shows_no_loop_and_no_rate() -> None:
    u = 50.0 + 50.0 * np.sign(np.sin(2.0 * np.pi * np.arange(4000) / 400.0 + 0.01))
    found = hyst.diagnose(record(u, plays(u), 0.02))
    assert found.named(NAME)
    assert not found.named("rate dependence")
    assert not found.named("loop")


def test_drives_that_go_through_their_range_leave_nothing_out() -> None:
    stairs = hyst.signals.staircase(DT, 0.0, 100.0, 1000.0, steps=10, hold=0.1).u
    for u in (triangle(), sine(), stairs):
        assert NAME not in warned(record(u, plays(u), 0.02))
    assert NAME not in {
        each.name
        for each in hyst.diagnose(
            [record(two_levels(1), plays(two_levels(1)), 0.02), record(sine(), plays(sine()), 0.02)]
        ).findings
    }


def test_no_model_of_two_levels_is_good() -> None:
    u = two_levels(3)
    found = hyst.identify(record(u, plays(u), 0.02))
    assert found.verdict.level == "fair"
    assert any("there is no sample" in each for each in found.verdict.sentences)

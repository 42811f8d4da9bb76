"""What was driven, how wide the loop is, how noisy the output, and how many amplitudes."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import DT, NESTED, Array, play, plays, record, sine, through, triangle

import hyst


def test_levels_ranges_rates_and_period() -> None:
    u = through([0.0, 100, 0, 50, 0, 100, 25, 75, 0], 250)
    (found,) = hyst.diagnose(record(u, plays(u))).named("drive")
    # Reversals at 100 0 50 0 100 25 75; ranges 0-100, 0-50, 25-100, 25-75.
    assert (found.amounts["reversals"], found.amounts["levels"]) == (7.0, 5.0)
    assert found.amounts["ranges"] == 4.0
    # 100 V and 50 V in 0.25 s.
    assert found.amounts["fastest"] == pytest.approx(400.0)
    assert found.amounts["slowest"] == pytest.approx(200.0)
    assert "one within another" in found.sentence


def test_frequency_of_a_period_that_is_not_whole() -> None:
    u = sine(1000.0 / 3.0)
    (found,) = hyst.diagnose(record(u, plays(u))).named("drive")
    assert found.amounts["frequency"] == pytest.approx(3.0, rel=1e-4)
    assert found.amounts["samples per period"] == pytest.approx(333.33, abs=0.02)


def test_width_and_range_of_one_play() -> None:
    u = triangle()
    (found,) = hyst.diagnose(record(u, play(u, 5.0))).named("loop")
    # Two radii wide; the output runs from the 0 it starts at (or 5 once it has moved) to 95.
    assert found.amounts["width"] == pytest.approx(10.0, abs=0.3)
    assert found.amounts["range"] == pytest.approx(95.0, abs=1.0)
    assert "counter-clockwise" in found.sentence


def test_noise_is_told_only_where_something_repeats() -> None:
    u = triangle()
    (found,) = hyst.diagnose(record(u, plays(u), 0.3)).named("noise")
    assert found.amounts["noise"] == pytest.approx(0.3, rel=0.1)
    once = through([0.0, 100.0, 0.0])
    assert not hyst.diagnose(record(once, plays(once), 0.3)).named("noise")


@pytest.mark.parametrize(
    ("inputs", "told"),
    [
        ([triangle()], True),
        ([triangle(), sine()], True),
        ([through([0.0, 100.0, 0.0])], True),
        ([through(NESTED)], False),
        ([triangle(), triangle(high=60.0)], False),
        ([through([-50.0, 50, -50]), through([-20.0, 20, -20])], False),
    ],
    ids=["one", "two alike", "one loop", "nested", "two records", "two single loops"],
)
def test_one_amplitude_is_told(inputs: list[Array], told: bool) -> None:
    found = hyst.diagnose([record(u, plays(u)) for u in inputs]).named("amplitudes")
    assert bool(found) == told


def test_lag_and_radius_are_one_on_triangles_only() -> None:
    for drive, told in ((triangle, True), (sine, False)):
        u = drive()
        (found,) = hyst.diagnose(record(u, plays(u))).named("amplitudes")
        assert ("radius" in found.sentence) == told


def test_an_input_that_never_turns() -> None:
    (found,) = hyst.diagnose(hyst.Record(np.arange(50.0), np.arange(50.0), DT)).named("amplitudes")
    assert "does not turn round" in found.sentence

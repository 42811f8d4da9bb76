"""A band holds as many samples as it says, on drives that no fit has seen."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.bands import held_in_class, held_of
from benchmarks.plants import friction, major_loops, plays, shrinking_loops, switching
from simulated_records import TRUE_PI, drive

import hyst

NOISE = 0.01
U = drive(2000, seed=3)


def record(u: np.ndarray = U, seed: int = 0) -> hyst.Record:
    y = TRUE_PI(u)
    return hyst.Record(u, y + NOISE * np.random.default_rng(seed).standard_normal(u.size), 1e-3)


@pytest.fixture(scope="module")
def found() -> hyst.Identified:
    return hyst.identify(record(), family="pi", plays=3, delay=0)


@pytest.mark.parametrize("name", ["plays", "plays and a map", "envelope and plays"])
def test_it_holds_what_it_says_in_class(name: str) -> None:
    """Six actuators of 2000 samples each: their mean scatters by less than 0.01."""
    held = [held_in_class(name, 0.01, seed) for seed in range(100, 106)]
    assert 0.92 <= np.mean(held) <= 0.98


@pytest.mark.parametrize("loops", [major_loops(), shrinking_loops()], ids=["one", "shrinking"])
def test_it_covers_actuators_of_no_class(loops: np.ndarray) -> None:
    """Nested minor loops of one actuator of each kind that are hard; see benchmarks/bands.py."""
    plants = [switching()[0], switching()[3], friction()[5], friction()[9], plays()[5]]
    held = [held_of(plant, loops) for plant in plants]
    assert np.mean([share for share, _ in held]) > 0.9
    # Percent of the range: a band of everything would be no use.
    assert np.mean([width for _, width in held]) < 20.0


def test_higher_levels_are_wider_and_the_model_is_inside(found: hyst.Identified) -> None:
    y = found.predict(U)
    widths = []
    for level in (0.5, 0.9, 0.95, 0.99):
        low, high = found.band(U, level)
        assert np.all((low < y) & (y < high))
        np.testing.assert_allclose(high - y, y - low, rtol=1e-9, atol=1e-12)
        widths.append(np.mean(high - low))
    assert np.all(np.diff(widths) > 0.0)


@pytest.mark.parametrize("level", [0.0, 1.0, -1.0, float("nan")])
def test_levels_that_are_none(found: hyst.Identified, level: float) -> None:
    with pytest.raises(hyst.InputError, match="level"):
        found.band(U, level)


def test_what_is_new_is_marked_and_wider(found: hyst.Identified) -> None:
    start = found.used[0].start
    assert not found.is_new(U)[start:].any()
    beyond = 2.0 * U
    assert found.is_new(beyond)[np.abs(beyond) > 1.3].all()


def test_extrapolation_from_one_amplitude_widens_the_band() -> None:
    """Whether smaller loops are plays' loops one amplitude does not show."""
    one = hyst.identify(record(np.sin(np.linspace(0.0, 25.0, 2000))), family="pi", plays=3, delay=0)
    low, high = one.band(U)
    major = np.sin(np.linspace(0.0, 25.0, 2000))
    major_low, major_high = one.band(major)
    assert np.mean(high - low) > 1.5 * np.mean(major_high - major_low)


@pytest.mark.parametrize("power", [-30, 40])
def test_powers_of_two_scale_it_to_the_bit(power: int) -> None:
    given, scale = record(), 2.0**power
    plain = hyst.identify(given, family="pi", plays=3, delay=0).band(U)
    scaled = hyst.identify(
        hyst.Record(given.u * scale, given.y / scale, given.dt), family="pi", plays=3, delay=0
    ).band(U * scale)
    for a, b in zip(plain, scaled, strict=True):
        np.testing.assert_array_equal(a, b * scale)


def test_a_delay_moves_it(found: hyst.Identified) -> None:
    y = np.concatenate([np.full(4, TRUE_PI(U)[0]), TRUE_PI(U)])[: U.size]
    noise = NOISE * np.random.default_rng(1).standard_normal(U.size)
    late = hyst.identify(hyst.Record(U, y + noise, 1e-3), family="pi", plays=3, delay=4)
    low, high = late.band(U)
    assert np.mean((y >= low) & (y <= high)) > 0.97  # without noise: all but what is misfit

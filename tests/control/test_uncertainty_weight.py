"""Weights as covers of measured plants: never below a sample, tight, of least order."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hyst
from hyst.control import (
    LinearSystem,
    UncertaintyWeight,
    as_linear_system,
    discretize,
    uncertainty_weight,
)
from hyst.control.uncertainty.weight import TIGHT

control = pytest.importorskip("control")

Array = np.ndarray
AT = np.geomspace(10.0, 1e5, 100)


def values(system: LinearSystem, w: Array) -> Array:
    points = 1j * w if system.dt == 0.0 else np.exp(1j * w * system.dt)
    return system.response(points)[:, 0, 0]


def is_stable_and_minimum_phase(found: UncertaintyWeight) -> bool:
    G = control.ss(*(getattr(found.system, each) for each in "ABCD"), found.system.dt or 0)
    roots = np.concatenate([G.poles(), G.zeros()])
    inside = np.abs(roots) < 1.0 if found.system.dt else roots.real < 0.0
    return bool(inside.all())


def of_radius(radius: Array, seed: int = 0) -> tuple[Array, Array]:
    """A response whose deviation from 1 is known, of any phase."""
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, radius.size)
    return AT, 1.0 + radius * np.exp(1j * phase)


def of_order(order: int, seed: int) -> Array:
    """The gain of a random weight; its corners a decade from the ends, where nothing is seen."""
    rng = np.random.default_rng(seed)
    zeros, poles = 10.0 ** rng.uniform(2.0, 4.0, (2, order))
    gain = np.prod(np.hypot(AT[:, None], zeros), axis=1) / np.prod(
        np.hypot(AT[:, None], poles), axis=1
    )
    return np.asarray(0.5 * gain / gain.max())


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_gain_of_a_weight_is_found_again(order: int, seed: int) -> None:
    radius = of_order(order, seed)
    found = uncertainty_weight(1.0, [of_radius(radius)], order, least=1e-6)
    gain = np.abs(values(found.system, AT))
    assert found.order == order
    assert is_stable_and_minimum_phase(found)
    assert np.all(gain >= radius * (1.0 - 1e-12))  # |1 + r exp(j p) - 1| rounds
    # A weight without excess exists: what is left is the end of the bisection, a thousandth, and a
    # little for not falling beyond the samples.
    assert gain.max() < 0.51
    assert np.all(gain <= 1.03 * radius)


@pytest.mark.parametrize("seed", range(4))
def test_no_weight_of_first_order_on_a_grid_is_tighter(seed: int) -> None:
    radius = of_order(3, seed)
    found = uncertainty_weight(1.0, [of_radius(radius)], 1, least=1e-6)
    corners = np.geomspace(1.0, 1e6, 121)
    best = np.inf
    for corner in corners:
        shapes = np.hypot(AT[:, None], corners) / np.hypot(AT, corner)[:, None]
        ratio = shapes / radius[:, None]
        # Held below and above: no less at 0 and at infinity than at the ends of the samples.
        least = np.maximum.reduce(
            [1.0 / ratio.min(axis=0), radius[0] * corner / corners, np.full(121, radius[-1])]
        )
        best = min(best, float((ratio.max(axis=0) * least).min()))
    # Dips are filled, by which the excess told is not above that over the samples themselves.
    assert found.excess <= best * 1.002
    assert np.all(found.gain >= found.radius)


@pytest.mark.parametrize("seed", range(6))
def test_the_order_is_the_least_that_is_tight_enough(seed: int) -> None:
    radius = of_order(4, seed)
    found = uncertainty_weight(1.0, [of_radius(radius)], least=1e-6)
    assert found.excess <= TIGHT
    if found.order:
        below = uncertainty_weight(1.0, [of_radius(radius)], found.order - 1, least=1e-6)
        assert below.excess > TIGHT


def resonance(frequency: float, damping: float) -> tuple[list[float], list[float]]:
    w = 2.0 * np.pi * frequency
    return [w * w], [1.0, 2.0 * damping * w, w * w]


def test_resonances_that_move_are_covered_wherever_they_are_looked_at() -> None:
    moved = [resonance(f, z) for f in (190.0, 210.0) for z in (0.025, 0.035)]
    found = uncertainty_weight(resonance(200.0, 0.03), moved)
    # Grid of our own, denser about the resonance than the one that was covered.
    w = 2.0 * np.pi * np.union1d(np.geomspace(1.0, 5000.0, 400), np.linspace(185.0, 215.0, 601))
    s = 1j * w
    nominal = values(as_linear_system(resonance(200.0, 0.03)), w)
    for num, den in moved:
        off = np.abs(np.polyval(num, s) / np.polyval(den, s) / nominal - 1.0)
        assert np.all(off <= 1.01 * np.abs(values(found.system, w)))  # lines between its points
    assert found.excess < TIGHT
    assert found.order <= 5
    assert is_stable_and_minimum_phase(found)


def test_the_weight_of_a_sampled_plant_is_sampled_and_holds_up_to_half_the_rate() -> None:
    plants = [hyst.models.resonance(f, 0.05, 1e-3, delay=2) for f in (100.0, 95.0, 105.0)]
    found = uncertainty_weight(plants[0], plants[1:])
    f = np.union1d(np.linspace(1.0, 500.0, 500), np.linspace(90.0, 110.0, 201))
    gain = np.abs(values(found.system, 2.0 * np.pi * f))
    assert found.system.dt == 1e-3
    assert is_stable_and_minimum_phase(found)
    for each in plants[1:]:
        off = np.abs(each.frequency_response(f) / plants[0].frequency_response(f) - 1.0)
        assert np.all(off <= 1.01 * gain)


def test_every_way_to_give_a_response_gives_the_same_weight() -> None:
    w = 2.0 * np.pi * np.geomspace(1.0, 1000.0, 60)
    measured = values(as_linear_system(resonance(210.0, 0.1)), w)
    ways: list[Any] = [
        (w, measured),
        control.frd(measured, w),
        hyst.signals.MeasuredResponse(w / (2.0 * np.pi), measured),
    ]
    weights = [uncertainty_weight(resonance(200.0, 0.1), [each], 3) for each in ways]
    as_system = uncertainty_weight(resonance(200.0, 0.1), [resonance(210.0, 0.1)], 3, w=w)
    for each in (*weights[1:], as_system):
        # Hz to rad/s and back rounds.
        np.testing.assert_allclose(each.radius, weights[0].radius, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(each.gain, weights[0].gain, rtol=1e-3)


def test_several_responses_are_covered_together() -> None:
    first, second = of_order(2, 1), 2.0 * of_order(1, 2)
    found = uncertainty_weight(1.0, [of_radius(first, 1), of_radius(second, 2)])
    assert np.all(np.abs(values(found.system, AT)) >= np.maximum(first, second) * (1.0 - 1e-12))


def test_noise_makes_no_weight_of_high_order() -> None:
    rng = np.random.default_rng(5)
    smooth = 0.05 + 0.5 * AT**2 / (1e8 + AT**2)
    noisy = [of_radius(smooth * np.abs(rng.normal(size=AT.size)), k) for k in range(3)]
    found = uncertainty_weight(1.0, noisy)
    assert np.all(found.gain >= found.radius)
    # The largest of three normal numbers is above 3 once in a hundred, 300 are drawn.
    assert np.all(found.gain < 6.0 * smooth)
    assert found.order <= 4


def test_dead_time_of_a_continuous_plant_counts() -> None:
    late = hyst.models.resonance(50.0, 0.3, 1e-3, delay=3).to_continuous()
    f = np.array([1.0, 10.0, 40.0, 100.0])
    same = (2.0 * np.pi * f, late.frequency_response(f))
    assert uncertainty_weight(late, [same]).radius.max() == pytest.approx(0.01, rel=1e-12)
    without = (2.0 * np.pi * f, late.frequency_response(f) * np.exp(2j * np.pi * f * 0.003))
    found = uncertainty_weight(late, [without])
    # |exp(j w T) - 1| = 2 sin(w T / 2), by hand.
    at = np.isin(found.w, 2.0 * np.pi * f)
    np.testing.assert_allclose(found.radius[at], 2.0 * np.sin(np.pi * f * 0.003), rtol=1e-9)


def test_gains_are_matched_where_that_is_asked() -> None:
    w = np.geomspace(1.0, 1e3, 50)
    measured = 3.7 * values(as_linear_system(([100.0], [1.0, 100.0])), w)
    found = uncertainty_weight(
        ([100.0], [1.0, 100.0]), [(w, measured)], matched_at=2.0 / (2.0 * np.pi)
    )
    assert found.order == 0
    assert found.radius.max() < 0.011
    apart = uncertainty_weight(([100.0], [1.0, 100.0]), [(w, measured)])
    assert apart.radius.min() == pytest.approx(2.7, rel=1e-9)


@pytest.mark.parametrize("unit", [2.0**-20, 2.0**20])
def test_units_of_the_plant_do_not_matter(unit: float) -> None:
    plain = uncertainty_weight(resonance(200.0, 0.1), [resonance(210.0, 0.1)])
    num, den = resonance(200.0, 0.1)
    moved_num, moved_den = resonance(210.0, 0.1)
    other = uncertainty_weight(([unit * num[0]], den), [([unit * moved_num[0]], moved_den)])
    # Responses round; the bisection ends within a thousandth.
    np.testing.assert_allclose(other.gain, plain.gain, rtol=1e-3)


def test_samples_above_half_the_rate_are_left_out() -> None:
    plant = hyst.models.resonance(100.0, 0.3, 1e-3)
    f = np.array([10.0, 100.0, 400.0])
    inside = plant.frequency_response(f)
    w = 2.0 * np.pi * np.append(f, 700.0)
    found = uncertainty_weight(plant, [(w, np.append(inside, 100.0 + 0j))])
    assert found.radius.max() == pytest.approx(0.01, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"responses": []}, "give one or more"),
        ({"responses": "a.csv"}, "give one or more"),
        ({"responses": [(AT, np.ones(3) + 0j)]}, "100 frequencies and 3 values"),
        ({"responses": [([1.0], [complex("nan")])]}, "not finite"),
        ({"responses": [([-1.0], [1.0 + 0j])]}, "below 0"),
        ({"responses": [control.frd(np.ones((2, 1, 1)), [1.0])]}, "1 inputs and 2 outputs"),
        ({"responses": ["P"]}, "response 1 is str"),
        ({"nominal": 0.0}, r"nominal plant is 0 at 1\.59155 Hz"),
        ({"order": 9}, "order is 9"),
        ({"least": 0.0}, "least is 0"),
        ({"matched_at": 1e9}, "response 1 is not known at 1e[+]09 Hz"),
        ({"nominal": hyst.models.resonance(10.0, 0.1, 0.9 / 30.0 / 30.0, delay=1)}, None),
        ({"nominal": hyst.models.resonance(0.01, 0.1, 10.0)}, "above half the sample rate"),
    ],
)
def test_bad_input_is_refused_by_name(change: dict[str, Any], told: str | None) -> None:
    given: dict[str, Any] = {"nominal": 1.0, "responses": [of_radius(of_order(1, 0))]} | change
    nominal, responses = given.pop("nominal"), given.pop("responses")
    if told is None:
        assert uncertainty_weight(nominal, responses, **given).order >= 0
        return
    with pytest.raises(hyst.InputError, match=told):
        uncertainty_weight(nominal, responses, **given)


@pytest.mark.parametrize("dt", [0.0, 1e-3])
def test_plants_that_begin_elsewhere_are_covered_at_all_frequencies(dt: float) -> None:
    """Of the slower plant more is off at rest than of the one whose grid begins first."""
    moved = (3.9, 0.03), (4.1, 0.08), (4.2, -0.05)
    plants = [([(1.0 + more) * w**2], [1.0, 0.002 * w, w**2]) for w, more in moved]
    nominal = as_linear_system(([16.0], [1.0, 0.008, 16.0]))
    systems = [as_linear_system(each) for each in plants]
    if dt:
        nominal, *systems = (discretize(each, 0.1, "zoh") for each in (nominal, *systems))
    found = uncertainty_weight(nominal, systems)
    w = np.concatenate([np.geomspace(1e-4, 30.0, 4000), 4.0 * (1.0 + np.linspace(-0.1, 0.1, 4001))])
    points = np.exp(0.1j * w) if dt else 1j * w
    P = [each.response(points)[:, 0, 0] for each in (nominal, *systems)]
    off = np.max([np.abs(each / P[0] - 1.0) for each in P[1:]], axis=0)
    # Between samples that are an eighth of a half-width apart a peak is rounder than lines are.
    assert (off / np.abs(found.system.response(points)[:, 0, 0])).max() < 1.005


@pytest.mark.parametrize("seed", [0, 7, 8, 12, 21])
def test_a_cover_does_not_dip_between_samples(seed: float) -> None:
    """Against the straight lines, in logarithms, between samples 9 % apart."""
    w, draw = np.geomspace(1.0, 1e3, 80), np.random.default_rng(seed)
    places = np.log(np.geomspace(1.0, 1e3, 12))
    radius = np.exp(np.interp(np.log(w), places, draw.uniform(-4.0, 2.0, 12)))
    nominal = as_linear_system(([100.0], [1.0, 100.0]))
    found = uncertainty_weight(nominal, [(w, (1.0 + radius) * values(nominal, w))], order=6)
    between = np.geomspace(1.0, 1e3, 30_000)
    line = np.exp(np.interp(np.log(between), np.log(w), np.log(np.maximum(radius, 0.01))))
    # Lines are asked at five points each.
    assert (line / np.abs(values(found.system, between))).max() < 1.003

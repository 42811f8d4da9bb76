"""Plays between two envelopes: the equation, one envelope, the inverse, and what is refused."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from numpy.typing import NDArray

import hyst
from hyst import DeadZone, InputError, NotInvertibleError, TwoEnvelopePrandtlIshlinskii
from reference.examples import DOWN, TWO_ENVELOPE, UP
from reference.random_operators import signals, two_envelopes
from reference.two_envelopes import dead_zone
from reference.two_envelopes import two_envelopes as by_equation

Array = NDArray[np.float64]

EPS = float(np.finfo(np.float64).eps)


def expected(model: TwoEnvelopePrandtlIshlinskii, u: Array) -> Array:
    maps = [dead_zone(m.weights, m.thresholds) for m in (model.rising, model.falling)]
    return by_equation(model.p, model.r, maps[0], maps[1], model.p0, u)


@given(model=two_envelopes(), u=signals())
def test_it_is_its_equation(model: TwoEnvelopePrandtlIshlinskii, u: Array) -> None:
    # Some thirty roundings of terms of at most the slopes (4) times the input (8) and the weights.
    size = 32.0 * (1.0 + model.p0 + model.p.sum())
    assert np.abs(model(u) - expected(model, u)).max() <= 30.0 * EPS * size


@given(model=two_envelopes(), u=signals())
def test_with_equal_envelopes_it_is_the_generalized_model_to_the_bit(
    model: TwoEnvelopePrandtlIshlinskii, u: Array
) -> None:
    one = TwoEnvelopePrandtlIshlinskii(model.p, model.r, model.rising, model.rising, model.p0)
    plays = hyst.PrandtlIshlinskii(model.p, model.r, model.p0)
    generalized = hyst.GeneralizedPrandtlIshlinskii(model.rising, plays)
    assert one(u).tobytes() == generalized(u).tobytes()


@given(model=two_envelopes(0.25), u=signals(), tail=signals())
def test_the_inverse_gives_the_input_back_both_ways(
    model: TwoEnvelopePrandtlIshlinskii, u: Array, tail: Array
) -> None:
    """Slopes of y are p0 / 6 at least: rounding of y, some 30 eps of its terms, grows by 24."""
    inverse = model.inverse()
    size = 32.0 * (1.0 + model.p0 + model.p.sum())
    bound = 24.0 * 30.0 * EPS * size
    assert np.abs(inverse(model(u)) - u).max() <= bound
    # Any output can be asked for, in pieces, each with its own state.
    first, state = inverse.run(u)
    second, _ = inverse.run(tail, state)
    back = model(np.concatenate([first, second]))
    assert np.abs(back - np.concatenate([u, tail])).max() <= bound


def test_many_plays_on_a_rough_drive_come_back() -> None:
    rng = np.random.default_rng(3)
    r = 0.35 + np.cumsum(rng.exponential(0.05, 60))
    model = TwoEnvelopePrandtlIshlinskii(rng.exponential(0.05, 60), r, UP, DOWN, 0.3)
    u = np.clip(np.cumsum(rng.standard_normal(4000)), -6.0, 6.0)
    # As above: 120 roundings of terms up to 6 (1 + 3), slopes of at least 0.3 times 0.3.
    assert np.abs(model.inverse()(model(u)) - u).max() <= 11.0 * 120.0 * EPS * 24.0


def test_loops_by_hand_are_wider_at_one_end() -> None:
    # up: slope 1, then 1/2 beyond 1; down: slope 1, then 1/2 below -1; r = 1.
    up, down = DeadZone([1.0, -0.5], [0.0, 1.0]), DeadZone([1.0, -0.5], [0.0, -1.0])
    model = TwoEnvelopePrandtlIshlinskii([1.0], [1.0], up, down)
    # z = up - 1 on the way up, 1 at 3 and 4 at 9, and down + 1 on the way down, -4 at -9. Back at 3
    # it rests at 4, for down + 1 is 4 there; so does it at -3, where up - 1 is -4.
    assert model([3.0, 9.0, 3.0, -9.0, -3.0]).tolist() == [1.0, 4.0, 4.0, -4.0, -4.0]


def test_it_starts_without_memory() -> None:
    assert TWO_ENVELOPE.initial_state().tolist() == [0.0, 0.0, 0.0]
    assert TWO_ENVELOPE([0.0]).tolist() == [0.0]
    # The inverse: plays, last output and input, and the slope there, 0.4 (1 + 0.7) / 2.
    assert TWO_ENVELOPE.inverse().initial_state() == pytest.approx([0, 0, 0, 0, 0, 0.34], rel=1e-15)


def test_the_inverse_of_the_inverse_is_the_model() -> None:
    assert TWO_ENVELOPE.inverse().inverse() == TWO_ENVELOPE


REFUSED = {
    "a negative weight": (
        ([-0.5], [1.0], UP, DOWN),
        "p[0] is -0.5; between two envelopes weights are zero or positive",
    ),
    "a negative linear part": (([0.5], [1.0], UP, DOWN, -0.1), "p0 is -0.1; between two envelopes"),
    "a falling envelope": (
        ([0.5], [1.0], DeadZone([1.0, -1.5], [0.0, 2.0]), DOWN),
        "rising falls from 2 to inf, its slope there is -0.5",
    ),
    "the other one falling to the left": (
        ([0.5], [1.0], UP, DeadZone([1.0, -1.5], [0.0, -2.0])),
        "falling falls from -inf to -2, its slope there is -0.5",
    ),
    # At 3 up is 4.5 and down 3: 1.5 apart, where two radii leave 1.
    "envelopes that cross": (
        (
            [0.5],
            [0.5],
            DeadZone([1.0, 0.5], [0.0, 0.0 + 3.0]),
            DeadZone([0.5, 1.0], [0.0, 3.0]),
        ),
        "the envelopes cross: at 3 falling is 1.5 below rising, more than the 2 r = 1",
    ),
    "envelopes that cross far out": (
        ([0.5], [0.5], DeadZone([1.0, 0.5], [0.0, 3.0]), DeadZone([1.0], [0.0])),
        "the envelopes cross far out on the right",
    ),
    "a map that jumps": (
        ([0.5], [0.5], DeadZone([1.0], [1.0], "by-direction"), DOWN),
        "rising is a dead-zone; give a two-sided DeadZone",
    ),
    "no map": (([0.5], [0.5], UP, hyst.Play(1.0)), "falling is a play; give a two-sided DeadZone"),
    "unsorted radii": (([0.5, 0.5], [2.0, 1.0], UP, DOWN), "sort the thresholds"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_is_no_model_is_refused(what: str) -> None:
    arguments, message = REFUSED[what]
    with pytest.raises(InputError, match=re.escape(message)):
        TwoEnvelopePrandtlIshlinskii(*arguments)  # type: ignore[arg-type]


def test_without_a_linear_part_nothing_moves_after_a_turn() -> None:
    model = TwoEnvelopePrandtlIshlinskii([0.5, 0.3], [0.5, 1.0], UP, DOWN)
    assert model([4.0, 3.9]).tolist()[0] == model([4.0, 3.9]).tolist()[1]
    with pytest.raises(NotInvertibleError, match="p0 is 0: without a part that has no memory"):
        model.inverse()


def test_flat_envelopes_have_no_inverse() -> None:
    flat = DeadZone([1.0, -1.0], [0.0, 2.0])
    model = TwoEnvelopePrandtlIshlinskii([0.5], [0.5], flat, flat, 1.0)
    assert model([2.0, 3.0]).tolist() == [2.75, 2.75]
    with pytest.raises(NotInvertibleError, match="both envelopes are flat from 2 to inf"):
        model.inverse()
    # One of them flat, the other not: the mean rises, and there is one.
    steep = DeadZone([1.0, -0.5], [0.0, 2.0])
    u = np.array([3.0, 5.0, -1.0, 4.0])
    model = TwoEnvelopePrandtlIshlinskii([0.5], [0.5], flat, steep, 1.0)
    # Slopes of 1/4 at least: a dozen roundings of numbers up to 5, times four.
    assert np.abs(model.inverse()(model(u)) - u).max() <= 48.0 * EPS * 5.0


def test_other_units_scale_it_to_the_bit() -> None:
    u = np.sin(np.arange(200.0)) * 5.0
    for input_scale, output_scale in ((2.0**40, 2.0**-30), (2.0**-8, 2.0**70)):
        scaled = TWO_ENVELOPE.in_units(input_scale, output_scale)
        assert (scaled(u * input_scale) == TWO_ENVELOPE(u) * output_scale).all()
        inverse = TWO_ENVELOPE.inverse()
        back = inverse.in_units(output_scale, input_scale)
        assert (back(u * output_scale) == inverse(u) * input_scale).all()

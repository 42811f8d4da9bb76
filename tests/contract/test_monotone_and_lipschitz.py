"""Order and distance of inputs carry over to outputs, as declared."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import Affine, DeadZone, Operator, Play, PrandtlIshlinskii, Stop
from reference.numpy_operators import EPS
from reference.random_operators import numbers, operators_that, signals
from reference.rounding import rounding_of


@operators_that(lambda operator: operator.traits().monotone)
@given(data=st.data())
def test_a_rising_input_lets_no_output_fall(
    operators: st.SearchStrategy, data: st.DataObject
) -> None:
    operator = data.draw(operators)
    u = np.concatenate([data.draw(signals(most=10)), np.sort(data.draw(signals(most=20)))])
    side = data.draw(st.sampled_from((1.0, -1.0)))
    rising = np.flatnonzero(np.diff(u) >= 0.0)
    tolerance = rounding_of(operator, side * u)
    assert (side * np.diff(operator(side * u)))[rising].min(initial=0.0) >= -tolerance


@operators_that(lambda operator: math.isfinite(operator.lipschitz_constant()))
@given(data=st.data())
def test_outputs_are_no_further_apart_than_declared(
    operators: st.SearchStrategy, data: st.DataObject
) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    shift = np.array(data.draw(st.lists(numbers(-3.0, 3.0), min_size=u.size, max_size=u.size)))
    constant = operator.lipschitz_constant()
    tolerance = rounding_of(operator, u) + rounding_of(operator, u + shift)
    # Bounds u +- r of a play are rounded, too: twice, at no more than 8 + 3 + 5.
    tolerance += constant * 2.0 * EPS * 16.0
    apart = np.abs((u + shift) - u).max()  # as rounded
    assert np.abs(operator(u + shift) - operator(u)).max() <= constant * apart + tolerance


# Pairs of records one unit apart or less whose outputs are as far apart as the constant allows.
TIGHT = {
    "affine": (Affine(-2.5, 1.0), [0.0], [1.0], 2.5),
    "play": (Play(1.0), [2.0], [3.0], 1.0),
    # The play ends at 9 - 1, then u = 9; or at 8 + 1, where it was at 10 - 1, then u = 8: the
    # input is one lower, the play one higher, the stop two lower.
    "stop": (Stop(1.0), [9.0, 9.0], [10.0, 8.0], 2.0),
    "dead-zone": (DeadZone([1.0, 2.0, -5.0], [0.0, 1.0, -3.0]), [-4.0], [-5.0], 4.0),
    "pi": (PrandtlIshlinskii([0.5, 0.25], [1.0, 2.0], p0=0.5), [3.0], [4.0], 1.25),
}


@pytest.mark.parametrize(("operator", "u", "v", "factor"), TIGHT.values(), ids=list(TIGHT))
def test_the_constants_are_the_smallest(
    operator: Operator, u: list[float], v: list[float], factor: float
) -> None:
    assert np.abs(np.subtract(u, v)).max() == 1.0
    assert np.abs(operator(u) - operator(v)).max() == factor
    assert operator.lipschitz_constant() == factor


def test_a_jump_has_no_constant() -> None:
    operator = DeadZone([1.0], [1.0], "by-direction")
    assert operator.lipschitz_constant() == math.inf
    # Resting at 3 the output is 0, rising to it from just below it is 2.
    below = np.nextafter(3.0, 0.0)
    assert operator([3.0, 3.0])[-1] == 0.0
    assert operator([below, 3.0])[-1] == 2.0


# Operators with a falling piece, an input that rises along it, and the fall it must show.
FALLING = {
    "affine": (Affine(-1.0), [0.0, 2.0], -2.0),
    "dead-zone": (DeadZone([1.0, -3.0], [0.0, 1.0]), [1.0, 2.0], -2.0),
    "by direction": (DeadZone([1.0], [1.0], "by-direction"), [3.0, 3.0], -2.0),
    # c_1 = 0.5 - 1: once the play moves, the output falls by a half a unit.
    "pi": (PrandtlIshlinskii([-1.0], [1.0], p0=0.5), [1.0, 3.0], -1.0),
    "composition": (Affine(-1.0) @ Play(1.0), [1.0, 3.0], -2.0),
    # Slopes 0.5, 1.5, 0.5; but the first play was left so high that the second moves alone.
    "pi with impossible memory": (
        PrandtlIshlinskii([1.0, -1.0], [1.0, 2.0], p0=0.5, z0=[9.0, 0.0]),
        [8.0, 9.0],
        -0.5,
    ),
}


@pytest.mark.parametrize(("operator", "u", "fall"), FALLING.values(), ids=list(FALLING))
def test_what_falls_does_not_say_it_is_monotone(
    operator: Operator, u: list[float], fall: float
) -> None:
    assert not operator.traits().monotone
    y = operator(u)
    assert y[-1] - y[-2] == fall

"""The operators against reference implementations written from the papers' equations."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from hyst import DeadZone, Operator, Play, Stop
from reference.examples import EXAMPLES
from reference.numpy_operators import (
    EPS,
    flat,
    has_twin,
    jumps_behind_rounding,
    play_by_cases,
    simulate,
    stop_by_increments,
)
from reference.random_operators import RANDOM, SINGLE, numbers, signals

Array = NDArray[np.float64]

# The kinds of other papers have reference implementations of their own.
TWINS = {name: each for name, each in EXAMPLES.items() if has_twin(each.to_dict())}
KINDS = sorted({each.kind for each in TWINS.values()} | {"inverse"})


def assert_same(operator: Operator, u: Array) -> None:
    y, memory = operator.run(u)
    twin = simulate(operator.to_dict(), u)
    # The bound counts one rounding for every product and sum, and what stages pass on; the twin's
    # own exact sums are rounded once.
    assert np.abs(y - twin.y).max() <= twin.rounding
    assert memory.shape == twin.memory.shape
    stages = flat(operator.to_dict())
    if len(stages) == 1 and stages[0]["kind"] in SINGLE:
        # Fed with the same numbers, a memory is clamped by the same two roundings: equal bits,
        # but for the sign of a zero.
        assert (memory == twin.memory).all()
    else:
        assert np.abs(memory - twin.memory).max(initial=0.0) <= twin.memory_rounding


def test_no_example_is_left_out() -> None:
    assert not any(jumps_behind_rounding(each.to_dict()) for each in TWINS.values())


@pytest.mark.parametrize("operator", TWINS.values(), ids=list(TWINS))
@given(u=signals())
def test_examples(operator: Operator, u: Array) -> None:
    assert_same(operator, u)


@pytest.mark.parametrize("kind", KINDS)
@given(data=st.data())
def test_random_operators(kind: str, data: st.DataObject) -> None:
    operator, u = data.draw(RANDOM[kind]), data.draw(signals())
    assume(not jumps_behind_rounding(operator.to_dict()))
    assert_same(operator, u)


@pytest.mark.parametrize("kind", SINGLE)
@given(data=st.data())
def test_memory_from_any_state(kind: str, data: st.DataObject) -> None:
    """A record cut anywhere: the memory of the twin's whole run is the memory of the last piece."""
    operator, u = data.draw(RANDOM[kind]), data.draw(signals())
    state = operator.initial_state()
    for value in u:
        _, state = operator.run([value], state)
    assert (state == simulate(operator.to_dict(), u).memory).all()


@given(r=numbers(0.0, 5.0), u=signals())
def test_the_play_of_three_cases(r: float, u: Array) -> None:
    """S0 eq. 8 assumes that the play is in reach of its input, as it is from no memory at u = 0."""
    u = np.concatenate([[0.0], u])
    assert (Play(r)(u) == play_by_cases(u, r, 0.0)).all()


@given(r=numbers(0.0, 5.0), u=signals())
def test_the_stop_of_increments(r: float, u: Array) -> None:
    # The increments add up one rounding of a number below 16, and the play another, per sample.
    tolerance = 3.0 * u.size * EPS * 16.0
    assert np.abs(Stop(r)(u) - stop_by_increments(u, r)).max() <= tolerance


@given(r=numbers(0.0, 5.0), u=signals())
def test_play_and_stop_share_the_input(r: float, u: Array) -> None:
    # y = u - z is rounded once, and so is the sum; all numbers are below 16.
    assert np.abs(Play(r)(u) + Stop(r)(u) - u).max() <= 2.0 * EPS * 16.0


@given(u=signals())
def test_no_width_is_the_identity_and_nothing(u: Array) -> None:
    assert (Play(0.0)(u) == u).all()
    assert not Stop(0.0)(u).any()


def test_dead_zones_by_hand() -> None:
    two_sided = DeadZone([2.0, 10.0, 100.0], [1.0, -3.0, 0.0])
    # 100 u; plus 2 (u - 1) above 1; plus 10 (u + 3) below -3.
    assert two_sided([0.0, 1.0, 4.0, -3.0, -5.0]).tolist() == [0.0, 100.0, 406.0, -300.0, -520.0]
    by_direction = DeadZone([2.0, 10.0], [1.0, -3.0], "by-direction")
    # S0 eq. 3 with eta = 1 and -3, from u(-1) = 0:
    #   4, rising:   4 - 1 = 3, 4 + 3 = 7         5, rising:  4, 8
    #   2, falling:  2 < -1 is false, 2 < 3: 2 - 3 = -1
    #   2, resting:  0, 0                        -2, falling: -2 + 1 = -1, -2 - 3 = -5
    u = [4.0, 5.0, 2.0, 2.0, -2.0]
    assert by_direction(u).tolist() == [76.0, 88.0, -10.0, 0.0, -52.0]

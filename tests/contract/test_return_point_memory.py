"""Return-point memory and wiping out: a closed inner loop leaves no trace."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hyst import DeadZone, GeneralizedPrandtlIshlinskii, Operator, Play, PrandtlIshlinskii
from hyst.operators import Chained, Degree
from reference.random_operators import SINGLE, numbers, operators_that, signals
from reference.rounding import rounding_of


def is_exact(operator: Operator) -> bool:
    return operator.traits().rate_independent is Degree.EXACTLY


@operators_that(lambda operator: operator.traits().return_point_memory)
@given(data=st.data())
def test_an_inner_loop_is_wiped_out(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator = data.draw(operators)
    history, tail = data.draw(signals(most=10)), data.draw(signals(most=10))
    side = data.draw(st.sampled_from((1.0, -1.0)))
    start = data.draw(numbers(-6.0, 6.0))
    turn = start + side * data.draw(numbers(0.0, 6.0))
    fractions = np.array(data.draw(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=8)))
    # The inner loop leaves the extremum `turn` and stays inside the branch that led to it.
    inner = np.clip(turn + fractions * (start - turn), min(start, turn), max(start, turn))

    before = np.concatenate([history, [start, turn]])
    plain, looped = before, np.concatenate([before, inner, [turn]])
    (y, state), (y_looped, state_looped) = operator.run(plain), operator.run(looped)
    after = operator.run(tail, state)[0]
    after_looped = operator.run(tail, state_looped)[0]

    if isinstance(operator, Chained) or not is_exact(operator):
        # Behind a sum with weights of both signs the inner loop may pass its ends by rounding.
        whole = np.concatenate([looped, tail])
        tolerance = rounding_of(operator, whole)
        assert abs(y_looped[-1] - y[-1]) <= tolerance
        assert np.abs(after_looped - after).max() <= tolerance
    else:
        assert y_looped[-1] == y[-1]
        assert state_looped.tobytes() == state.tobytes()
        assert after_looped.tobytes() == after.tobytes()


def is_one_with_return_point_memory(operator: Operator) -> bool:
    single = is_exact(operator) and not isinstance(operator, Chained)
    return operator.traits().return_point_memory and single


@operators_that(is_one_with_return_point_memory, SINGLE)
@given(data=st.data())
def test_wiped_memory_stays_wiped_to_the_bit(
    operators: st.SearchStrategy, data: st.DataObject
) -> None:
    """An excursion beyond everything before it makes all histories alike."""
    operator = data.draw(operators)
    first, second = data.draw(signals()), data.draw(signals())
    # Thresholds and memories of the random operators are below 50, so 1e3 pushes every play.
    sweep = np.array([1e3, -1e3])
    ends = [operator.run(np.concatenate([history, sweep]))[1] for history in (first, second)]
    assert ends[0].tobytes() == ends[1].tobytes()


def test_the_dead_zone_by_direction_forgets_where_it_turned() -> None:
    operator = DeadZone([1.0], [1.0], "by-direction")
    assert not operator.traits().return_point_memory
    # Returning to the extremum 3 from below gives 2 again, but a loop of one repeated sample
    # (an excursion of no size) gives 0.
    assert operator([0.0, 3.0])[-1] == 2.0
    assert operator([0.0, 3.0, 3.0])[-1] == 0.0


def test_a_play_behind_a_tent_sees_an_extremum_inside_the_loop() -> None:
    tent = DeadZone([1.0, -2.0], [0.0, 1.0])  # u up to 1, 2 - u beyond
    operator = GeneralizedPrandtlIshlinskii(tent, PrandtlIshlinskii([1.0], [0.5]))
    assert not operator.traits().return_point_memory
    assert not (Play(0.5) @ tent).traits().return_point_memory
    # From 0 straight to 2 the map gives 0, 0. The inner loop 2, 1, 2 passes the map's top of 1,
    # which pushes the play to 0.5, where it then rests.
    assert operator([0.0, 2.0])[-1] == 0.0
    assert operator([0.0, 2.0, 1.0, 2.0])[-1] == 0.5

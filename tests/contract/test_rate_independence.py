"""The speed at which the input passes its values changes nothing."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import DeadZone, Operator
from hyst.operators import Chained, Degree
from reference.random_operators import operators_that, signals
from reference.rounding import rounding_of


@operators_that(lambda operator: operator.traits().rate_independent)
@given(data=st.data())
def test_repeating_samples_repeats_outputs(
    operators: st.SearchStrategy, data: st.DataObject
) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    counts = np.array(data.draw(st.lists(st.integers(1, 4), min_size=u.size, max_size=u.size)))
    y, state = operator.run(u)
    y_slow, state_slow = operator.run(np.repeat(u, counts))
    if operator.traits().rate_independent is Degree.EXACTLY:
        # Clamping to the same interval twice moves nothing: bit for bit.
        assert y_slow.tobytes() == np.repeat(y, counts).tobytes()
        assert state_slow.tobytes() == state.tobytes()
    else:
        tolerance = rounding_of(operator, np.repeat(u, counts))
        assert np.abs(y_slow - np.repeat(y, counts)).max() <= tolerance


def is_the_same_however_finely_sampled(operator: Operator) -> bool:
    """Between two samples the signal inside a composition must not turn."""
    traits = operator.traits()
    return bool(traits.rate_independent) and (traits.monotone or not isinstance(operator, Chained))


@operators_that(is_the_same_however_finely_sampled)
@given(data=st.data())
def test_samples_between_do_not_matter(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    pieces = [u[:1]]
    for before, after in itertools.pairwise(u):
        fractions = np.sort(data.draw(st.lists(st.floats(0.0, 1.0), max_size=3)))
        low, high = min(before, after), max(before, after)
        between = np.clip(before + fractions * (after - before), low, high)
        pieces.append(np.append(between, after))
    ends = np.cumsum([piece.size for piece in pieces]) - 1
    y = operator(u)
    y_fine = operator(np.concatenate(pieces))[ends]
    degree = operator.traits().rate_independent
    if isinstance(operator, Chained) or degree is Degree.TO_ROUNDING:
        # Sums of weights of both signs are monotone up to rounding only.
        tolerance = rounding_of(operator, np.concatenate(pieces))
        assert np.abs(y_fine - y).max() <= tolerance
    else:
        assert y_fine.tobytes() == y.tobytes()


def test_the_dead_zone_by_direction_depends_on_rests() -> None:
    operator = DeadZone([1.0], [1.0], "by-direction")
    assert not operator.traits().rate_independent
    # S0 eq. 3: a sample that repeats the one before is neither rising nor falling, so its output
    # is 0 instead of u - eta = 2.
    assert operator([3.0, 3.0]).tolist() == [2.0, 0.0]


@pytest.mark.parametrize("width", [0.0, 0.5])
def test_the_dead_zone_by_direction_depends_on_the_way(width: float) -> None:
    operator = DeadZone([1.0], [width], "by-direction")
    # Straight from 2 to 3 it rises; over 4 it falls, and 3 < -eta does not hold.
    assert operator([2.0, 3.0])[-1] == 3.0 - width
    assert operator([2.0, 4.0, 3.0])[-1] == 0.0

"""Loops between the same two inputs have the same shape, whatever came before."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import (
    Composition,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    Operator,
    PrandtlIshlinskii,
)
from reference.random_operators import numbers, operators_that, signals
from reference.rounding import rounding_of


@operators_that(lambda operator: operator.traits().congruent_loops)
@given(data=st.data())
def test_minor_loops_are_vertical_shifts(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator = data.draw(operators)
    low = data.draw(numbers(-6.0, 6.0))
    up = low + np.array(data.draw(st.lists(numbers(0.0, 6.0), min_size=1, max_size=6).map(sorted)))
    loop = np.concatenate([[low], up, up[::-1], [low]])
    shapes, tolerance = [], 0.0
    for history in (data.draw(signals(most=10)), data.draw(signals(most=10))):
        u = np.concatenate([history, loop, loop])  # the first round closes the loop
        y = operator(u)[-loop.size :]
        shapes.append(y - y[0])
        tolerance += rounding_of(operator, u)
    assert np.abs(shapes[0] - shapes[1]).max() <= tolerance


# Slope 1 up to 1 and 3 beyond, after or between plays.
STEEPER = DeadZone([1.0, 2.0], [0.0, 1.0])
BANK = PrandtlIshlinskii([1.0], [1.0], p0=0.5)
CURVED_MEMORY = {
    "mpi": (ModifiedPrandtlIshlinskii(BANK, STEEPER), 1.5, 0.5),
    "composition": (STEEPER @ BANK, 1.5, 0.5),
    "map inside a named stage": (
        GeneralizedPrandtlIshlinskii(STEEPER, PrandtlIshlinskii([], [], p0=1.0)) @ BANK,
        1.5,
        0.5,
    ),
    # The last play rests as well, since its input moves by less than 2; its p0 halves the heights.
    "two deep": (Composition((BANK, Composition((STEEPER, BANK)))), 0.75, 0.25),
}


@pytest.mark.parametrize(
    ("operator", "from_above", "from_below"), CURVED_MEMORY.values(), ids=list(CURVED_MEMORY)
)
def test_a_curved_map_of_a_remembering_signal_breaks_congruency(
    operator: Operator, from_above: float, from_below: float
) -> None:
    assert not operator.traits().congruent_loops
    # The loop 0, 1, 0 is narrower than 2 r, so the play rests: at 0 + 1 coming from above, at
    # 0 - 1 from below. The bank's output goes from 1 to 1.5, where the map has slope 3, or from -1
    # to -0.5, where it has slope 1.
    for start, height in ((9.0, from_above), (-9.0, from_below)):
        y = operator([start, 0.0, 1.0, 0.0, 1.0, 0.0])
        assert y[-2] - y[-1] == height

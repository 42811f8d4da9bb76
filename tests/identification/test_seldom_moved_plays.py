"""Plays that the records move once are told, with what a sweep moves through them."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]


def strokes(*turns: float) -> Array:
    steps = [np.linspace(a, b, 60, endpoint=False) for a, b in itertools.pairwise(turns)]
    return np.concatenate([*steps, [turns[-1]]])


def actuator(u: Array) -> Array:
    """Two plays beside a line, by their definition: radii 1 and 4, weights 1 and 2."""
    z, found = [0.0, 0.0], []
    for each in u.tolist():
        z = [min(max(z[i], each - r), each + r) for i, r in enumerate((1.0, 4.0))]
        found.append(each + z[0] + 2.0 * z[1])
    return np.array(found)


@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_a_play_moved_once_is_told_with_what_it_adds(scale: float) -> None:
    u = strokes(0.0, 10.0, 0.0, 3.0, 0.0, 3.0, 0.0, 3.0, 1.0, 2.0)
    y = actuator(u)
    record = hyst.Record(scale * u, y, dt=1e-3)
    found = hyst.identify(record, family="pi", radii=[scale, 4.0 * scale], delay=0)
    told = [each for each in found.undetermined if "moved by one stroke" in each]
    # A stroke of 10 moves it by 2 (5 - 4), with weight 2 the output by 4 of 22: from the first turn
    # on, the output goes from 10 + 9 + 2 * 6 down to 0 + 1 + 2 * 4.
    assert len(told) == 1
    assert f"radius {4.0 * scale:.4g} or more" in told[0]
    assert "add 18 % of the output's range" in told[0]


def test_whole_loops_first_leave_nothing_to_tell() -> None:
    u = strokes(0.0, 10.0, 0.0, 10.0, 0.0, 10.0, 0.0, 3.0, 0.0, 3.0, 1.0, 2.0)
    record = hyst.Record(u, actuator(u), dt=1e-3)
    found = hyst.identify(record, family="pi", radii=[1.0, 4.0], delay=0)
    assert not [each for each in found.undetermined if "moved by one stroke" in each]

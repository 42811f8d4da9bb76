"""A correction along the branches of a hysteresis, from the slopes that were measured on them.

Between two turning points of a hysteresis with congruent loops the output depends on the way from
the last turn alone, so that a small change obeys

    dy(t) - dy(turn) = s(t) (dv(t) - dv(turn))

with s the slope at t. It is read off the repetition itself, and what is asked for is divided by it.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_TURN = 0.04
"""Of the range of the motion: smaller ways back are no turns."""

_WINDOW = 8
"""Part of the way of a branch to either side over which the slope is taken."""

_LEAST, _MOST = 0.4, 2.5
"""Slopes that are believed."""

_CLEAR = 30.0
"""Times the noise: the way in a window from which on a slope is believed by more than a half."""


def along_branches(wanted: Array, v: Array, expected: Array, y: Array, noise: float) -> Array:
    """Give the change of v for a wanted change of the output, its linear part taken off.

    Parameters
    ----------
    wanted
        Shape (N,).
    v
        What the model was told, shape (N,).
    expected, y
        What the linear part gives for v, and what was measured.
    noise
        Rms of what does not repeat.
    """
    change = np.empty(wanted.size)
    at = float(wanted[0])
    for first, last in pairwise(_turns(v)):
        part = slice(first, last + 1)
        slope = _slopes(expected[part], y[part], noise)
        change[part] = at + (wanted[part] - wanted[first]) / slope
        at = float(change[last])
    return change


def _turns(v: Array) -> list[int]:
    """Give the first sample, the turning points and the last sample."""
    least = _TURN * float(np.ptp(v))
    found, sense, extreme = [0], 0.0, 0
    for k, value in enumerate(v.tolist()):
        way = value - float(v[extreme])
        if sense == 0.0:
            if abs(way) > least:
                sense, extreme = float(np.sign(way)), k
        elif sense * way >= 0.0:
            extreme = k
        elif abs(way) > least:
            found.append(extreme)
            sense, extreme = -sense, k
    return sorted({*found, v.size - 1})


def _slopes(x: Array, y: Array, noise: float) -> Array:
    """Give the slope of y over x around every sample of a branch."""
    # By the way and not by time: where a motion slows down, creep and drift are no slope.
    way_gone = np.maximum.accumulate(x if x[-1] >= x[0] else -x)
    half = (way_gone[-1] - way_gone[0]) / _WINDOW
    first = np.searchsorted(way_gone, way_gone - half, side="left")
    beyond = np.searchsorted(way_gone, way_gone + half, side="right")
    count = (beyond - first).astype(float)

    def mean(signal: Array) -> Array:
        total = np.concatenate([[0.0], np.cumsum(signal)])
        return np.asarray((total[beyond] - total[first]) / count)

    own, out = x - x.mean(), y - y.mean()
    both = mean(own * out) - mean(own) * mean(out)
    way = mean(own * own) - mean(own) ** 2
    prior = (_CLEAR * noise) ** 2 / 12.0
    slope = (both + prior) / np.maximum(way + prior, 1e-300) if noise > 0.0 or way.any() else 1.0
    return np.clip(slope, _LEAST, _MOST)

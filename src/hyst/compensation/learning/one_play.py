"""Whether a play explains what looks like a delay: on a ramp the two are the same."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_RADII, _LARGEST = 12, 0.25
"""That are tried, and the largest of the range of the motion."""


def left_by_a_play(expected: Array, y: Array) -> float:
    """Give the least power that a gain, one play and an offset leave of an output.

    Parameters
    ----------
    expected, y
        Shape (N,).
    """
    radii = np.linspace(0.0, _LARGEST, _RADII + 1)[1:] * float(np.ptp(expected))
    least = float(np.var(y))
    for radius in radii.tolist():
        for start in (expected[0], expected[0] + radius, expected[0] - radius):
            moved = _play(expected, radius, float(start))
            columns = np.column_stack([np.ones(y.size), expected, moved])
            rest = y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]
            least = min(least, float(np.mean(rest**2)))
    return least


def left_by_a_shift(expected: Array, y: Array, lag: int) -> float:
    """Give the power that a gain, an offset and a delay leave, where the two overlap.

    Parameters
    ----------
    expected, y
        Shape (N,).
    lag
        Samples, 0 or more.
    """
    told, own = expected[: expected.size - lag], y[lag:]
    columns = np.column_stack([np.ones(own.size), told])
    rest = own - columns @ np.linalg.lstsq(columns, own, rcond=None)[0]
    return float(np.mean(rest**2))


def _play(x: Array, radius: float, at: float) -> Array:
    moved = np.empty(x.size)
    for k, value in enumerate(x.tolist()):
        at = max(value - radius, min(value + radius, at))
        moved[k] = at
    return moved

"""Smooth drives and references."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def through(levels: Sequence[float], speed: float, dt: float) -> Array:
    """Go from level to level, each stroke half a cosine, so that nothing is kicked.

    Parameters
    ----------
    levels
        Where to turn; strokes take as long as their length demands.
    speed
        Mean speed of a stroke, units per second.
    dt
        Sample time, s.

    Returns
    -------
    numpy.ndarray
        From the first level to the last.

    Examples
    --------
    >>> through([0.0, 1.0, 0.5], 1.0, 0.25).round(3)
    array([0.   , 0.146, 0.5  , 0.854, 1.   , 0.75 , 0.5  ])
    """
    pieces = [np.array([levels[0]])]
    for start, stop in pairwise(levels):
        count = max(round(abs(stop - start) / (speed * dt)), 1)
        share = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, count + 1) / count)
        pieces.append(start + (stop - start) * share)
    return np.concatenate(pieces)


def hold(level: float, seconds: float, dt: float) -> Array:
    """Stay at a level.

    Parameters
    ----------
    level
        Where.
    seconds
        How long.
    dt
        Sample time, s.

    Returns
    -------
    numpy.ndarray

    Examples
    --------
    >>> hold(2.0, 0.3, 0.1)
    array([2., 2., 2.])
    """
    return np.full(round(seconds / dt), level)


def with_holds(
    levels: Sequence[float], holds: Mapping[float, float], speed: float, dt: float
) -> Array:
    """Go from level to level and stay at some of them.

    Parameters
    ----------
    levels, speed, dt
        As of ``through``.
    holds
        For how long, s, by level.

    Returns
    -------
    numpy.ndarray

    Examples
    --------
    >>> with_holds([0.0, 1.0, 0.5], {1.0: 0.5}, 1.0, 0.25).round(3)
    array([0.   , 0.146, 0.5  , 0.854, 1.   , 1.   , 1.   , 0.75 , 0.5  ])
    """
    pieces = [np.array([levels[0]])]
    for start, stop in pairwise(levels):
        pieces += [through([start, stop], speed, dt)[1:], hold(stop, holds.get(stop, 0.0), dt)]
    return np.concatenate(pieces)


def staircase_and_sines(low: float, high: float, dt: float) -> Array:
    """Climb stairs up and down between two levels, then oscillate around their middle.

    Parameters
    ----------
    low, high
        Lowest and highest value.
    dt
        Sample time, s.

    Returns
    -------
    numpy.ndarray

    Examples
    --------
    >>> y = staircase_and_sines(10.0, 50.0, 1e-3)
    >>> float(y.min()), float(y.max())
    (10.0, 50.0)
    """
    steps = np.linspace(low, high, 5)
    middle, reach = 0.5 * (low + high), 0.5 * (high - low)
    pieces = []
    stairs = [*steps, *steps[-2::-1]]
    for before, after in zip([steps[0], *stairs[:-1]], stairs, strict=True):
        pieces += [through([before, after], 4.0 * (high - low), dt), hold(after, 0.15, dt)]
    pieces.append(through([low, middle], (high - low), dt))
    t = np.arange(round(2.0 / dt)) * dt
    swell = np.minimum(t / 0.4, 1.0)
    sines = 0.62 * np.sin(2.0 * np.pi * 1.5 * t) + 0.33 * np.sin(2.0 * np.pi * 4.0 * t)
    pieces.append(middle + reach * swell * sines)
    return np.concatenate(pieces)

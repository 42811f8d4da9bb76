"""What the paper prints: the plays and inputs of sec. IV, and the constants of sec. V."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from hyst.models import PrandtlIshlinskii

Array = NDArray[np.float64]

DT = 1e-3
P = np.array([0.3, 0.5, 0.8, 0.3, 0.2])
R = np.array([0.4, 1.0, 1.5, 2.0, 3.6])
PLAYS = PrandtlIshlinskii(P, R)
GAIN = 10.0

SLOPES = np.array([6.3460, 8.0195, 9.1747, 9.6224])
"""Of the four segments of the measured piezo's loop, um/V (sec. V-A)."""
WEIGHTS = np.array([6.3460, 1.6735, 1.1552, 0.4477])
RADII = np.array([0.0, 0.1945, 0.4826, 0.5707])
"""Of its four plays, the first of radius 0: um/V and V (sec. V-A, V-B)."""
PIEZO_GAIN = 20.0
PIEZO_RANGE, PIEZO_ERROR = 17.03, 0.122
"""Measured range of the output and largest error of the four plays, um (sec. V-B)."""
SEVEN_WEIGHTS = np.array([5.4194, 2.2159, 1.2423, 0.0852, 0.3505, 0.0145, 0.0099])
"""Of the conventional model with n = 7, radii (i - 1) / 6 V (sec. V-C)."""
MINOR_ERRORS = {"4 plays": 0.34, "n = 7": 0.48, "n = 10": 0.44}
"""Largest errors on the record with minor loops, um (sec. V-C, fig. 9)."""


def piezo() -> PrandtlIshlinskii:
    """Give the paper's model of its piezo, its play of radius 0 as the weight of the input."""
    return PrandtlIshlinskii(WEIGHTS[1:], RADII[1:], float(WEIGHTS[0]))


def fixed_radii(n: int, half_range: float = 1.0) -> Array:
    """Give the radii of the conventional model without the first, which is 0 (sec. V-C).

    Parameters
    ----------
    n
        How many plays, the first counted.
    half_range
        Half the range of the input, which the last radius is.
    """
    return np.arange(1, n) / (n - 1) * half_range


def sine(seconds: float) -> Array:
    """Give the input of fig. 2.

    Parameters
    ----------
    seconds
        How long.

    Returns
    -------
    numpy.ndarray
    """
    return np.asarray(30.0 * np.sin(2.0 * np.pi * np.arange(round(seconds / DT)) * DT))


def staircase(seconds: float) -> Array:
    """Give a biased staircase between -15 and 30, 200 steps a period of 2 s, as in fig. 3.

    Its steps of 0.45 are small enough for a radius of 0.4 to show by itself.

    Parameters
    ----------
    seconds
        How long.

    Returns
    -------
    numpy.ndarray
    """
    step = np.arange(round(seconds / DT)) // 10 % 200
    return np.asarray(-15.0 + 0.45 * np.minimum(step, 200 - step))


def triangle(corners: list[float], step: float) -> Array:
    """Give straight ways from corner to corner.

    Parameters
    ----------
    corners
        Two or more.
    step
        About what is gone in a sample.
    """
    ways = [np.array(corners[:1])]
    for start, end in itertools.pairwise(corners):
        ways.append(np.linspace(start, end, round(abs(end - start) / step) + 1)[1:])
    return np.concatenate(ways)


INPUTS = {"sine": sine, "staircase": staircase}

"""Hysteresis from a loading curve by recursion over the turning points, and from nothing else.

Written from S3 eqs. 2-3 and Masing's two rules, without a stack: the turning points that count are
found afresh for every sample, by walking the record and striking out what has been wiped out.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Curve = Callable[[float], float]


def power_law(c1: float, c2: float, c3: float) -> Curve:
    """S3 eq. 2 in the constants of theorem 4: the skeleton has 2^c3 c2 in the place of c2."""
    return lambda x: c1 * x + 2.0**c3 * c2 * x ** (c3 + 1.0) / (c3 + 1.0)


def turning_points(u: ArrayLike) -> list[float]:
    """Extremes of the path from 0 over all samples to the last, ends included."""
    points = [0.0]
    for value in np.asarray(u, dtype=float).tolist():
        if len(points) > 1 and (value - points[-1]) * (points[-1] - points[-2]) >= 0.0:
            points[-1] = value
        elif value != points[-1]:
            points.append(value)
    return points


def still_remembered(points: list[float]) -> list[float]:
    """The reversals that are not wiped out when the path ends at the last point."""
    kept: list[float] = []
    for point in points[1:]:
        while len(kept) >= 2 and abs(point - kept[-1]) >= abs(kept[-1] - kept[-2]):
            del kept[-2:]
        if len(kept) == 1 and abs(point) >= abs(kept[0]):
            kept = []
        kept.append(point)
    return kept


def masing_output(f: Curve, u: ArrayLike) -> float:
    """Output at the end of a record: the loading curve to the first reversal, then branches."""
    kept = still_remembered(turning_points(u))
    if not kept:
        return 0.0
    y = np.sign(kept[0]) * f(abs(kept[0]))
    for before, after in itertools.pairwise(kept):
        y += np.sign(after - before) * 2.0 * f(abs(after - before) / 2.0)
    return float(y)


def masing(f: Curve, u: Array) -> Array:
    """Outputs of a whole record with nested memory."""
    return np.array([masing_output(f, u[: k + 1]) for k in range(u.size)])


def last_reversal(f: Curve, u: Array) -> Array:
    """Outputs of a whole record with memory of the last reversal alone (S3 eq. 3)."""
    y = []
    for k in range(u.size):
        points = turning_points(u[: k + 1])
        total = 0.0
        for number, (before, after) in enumerate(itertools.pairwise(points)):
            way = after - before
            part = f(abs(way)) if number == 0 else 2.0 * f(abs(way) / 2.0)
            total += np.sign(way) * part
        y.append(total)
    return np.array(y)

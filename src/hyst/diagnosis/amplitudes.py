"""At which levels a drive turns round, and how many ranges that makes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.memory_branches import MOST_BRANCHES, turns_of

_NEAR = 0.03  # of the range: levels nearer than this are one


@dataclass(frozen=True)
class Amplitudes:
    """Turning levels of a drive.

    Parameters
    ----------
    turns
        Number of reversals.
    levels
        Different levels at which it turns round.
    ranges
        ``(low, high)``: different pairs of levels between which it goes.
    nested
        Whether some range lies within another.
    """

    turns: int
    levels: int
    ranges: tuple[tuple[float, float], ...]
    nested: bool


def amplitudes_of(u: NDArray[np.float64]) -> Amplitudes:
    """Count reversals, levels and ranges of a drive."""
    turns = turns_of(u)
    near = _NEAR * float(np.ptp(u))
    levels = u[turns[:MOST_BRANCHES]]
    ranges: list[tuple[float, float]] = []
    for one, other in pairwise(levels.tolist()):
        low, high = min(one, other), max(one, other)
        if not any(abs(low - a) <= near and abs(high - b) <= near for a, b in ranges):
            ranges.append((low, high))
        if len(ranges) >= 200:
            break
    if not ranges:
        # One reversal makes one range, from wherever the record begins.
        ranges.append((float(u.min()), float(u.max())))
    nested = any(
        a - near <= low and high <= b + near and high - low < b - a - near
        for low, high in ranges
        for a, b in ranges
    )
    return Amplitudes(int(turns.size), _distinct(levels, near), tuple(ranges), nested)


def ranges_of(records: Sequence[NDArray[np.float64]]) -> tuple[tuple[float, float], ...]:
    """Give the different ranges of all drives together."""
    if not records:
        return ()
    near = _NEAR * (max(float(u.max()) for u in records) - min(float(u.min()) for u in records))
    found: list[tuple[float, float]] = []
    for u in records:
        for low, high in amplitudes_of(u).ranges:
            if not any(abs(low - a) <= near and abs(high - b) <= near for a, b in found):
                found.append((low, high))
    return tuple(found)


def _distinct(levels: NDArray[np.float64], near: float) -> int:
    count, lowest = 0, -np.inf
    for level in np.sort(levels).tolist():
        if level - lowest > near:
            count, lowest = count + 1, level
    return count

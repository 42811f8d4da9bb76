"""Branches of a drive that begin with the same memory: there an output repeats, or drifts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.interpolation import earlier, first_comparable
from hyst.signals import estimate_noise, reversals

Array = NDArray[np.float64]
Segment = tuple[int, int, float]
Branch = tuple[int, int, tuple[float, ...]]

# Of a long record the first branches tell enough.
MOST_BRANCHES = 2000
_FEWEST_SAMPLES = 10
# What an output still owes to the branch before, if it lags.
_PASSED_OVER = 0.05


def turns_of(u: Array) -> NDArray[np.intp]:
    """Find the reversals of a drive that are no noise: beyond 1 % of its range, or what it has."""
    span = float(np.ptp(u))
    return reversals(u, min(max(0.01 * span, 8.0 * estimate_noise(u)), 0.05 * span))


def remembering_branches(u: Array) -> list[Branch]:
    """Cut a drive into branches ``(start, stop, levels)`` with what is remembered where they begin.

    A turning level is remembered until the drive reaches it again (Madelung's rules); levels
    within 1 % of the range are one. The last level is that of the beginning itself. The first
    branch, from wherever the record begins, is none of them.
    """
    turns = turns_of(u)[: MOST_BRANCHES + 1]
    if turns.size == 0:
        return []
    levels = _rounded(u[turns], 0.01 * float(np.ptp(u)))
    ends = np.append(turns[1:], u.size - 1)
    found = []
    stack: list[float] = []
    for level, start, end in zip(levels.tolist(), turns.tolist(), ends.tolist(), strict=True):
        rises = bool(u[end] > u[start])
        while len(stack) >= 2 and (level <= stack[-2] if rises else level >= stack[-2]):
            del stack[-2:]
        stack.append(level)
        found.append((start, end + 1, tuple(stack)))
    return found


def repeated_segments(u: Array) -> list[Segment]:
    """Give ``(start, stop, lag)``: samples at which memory and drive are as they were a lag ago."""
    tolerance = 0.01 * float(np.ptp(u))
    groups: dict[tuple[object, ...], list[tuple[int, int]]] = {}
    for start, stop, levels in remembering_branches(u):
        groups.setdefault((u[stop - 1] > u[start], *levels), []).append((start, stop))
    found = []
    for members in groups.values():
        for which, branch in enumerate(members):
            for before in reversed(members[max(which - 4, 0) : which]):
                segment = _aligned(u, before, branch, tolerance)
                if segment is not None:
                    found.append(segment)
                    break
    return sorted(found)


def _rounded(levels: Array, tolerance: float) -> Array:
    """Make levels within a tolerance of the lowest of them equal to it."""
    result = np.empty_like(levels)
    lowest = -np.inf
    for index in np.argsort(levels, kind="stable").tolist():
        if levels[index] - lowest > tolerance:
            lowest = float(levels[index])
        result[index] = lowest
    return result


def _aligned(
    u: Array, before: tuple[int, int], branch: tuple[int, int], tolerance: float
) -> Segment | None:
    """Lay two branches over one another to a part of a sample; None if they do not match."""
    count = min(before[1] - before[0], branch[1] - branch[0])
    skipped = max(2, round(_PASSED_OVER * count))
    start, stop = branch[0] + skipped, branch[0] + count - 2
    if stop - start < _FEWEST_SAMPLES:
        return None
    lag = float(branch[0] - before[0])
    for _ in range(2):
        window = _window(u, start, stop, lag)
        if window is None:
            return None
        slope = np.gradient(window)
        energy = float(slope @ slope)
        if energy == 0.0:
            break
        # u(t) = w(t) + slope d: the drive is d ahead of where this lag sees it, so less lag is due.
        ahead = float(slope @ (u[start:stop] - window)) / energy
        lag -= min(max(ahead, -2.0), 2.0)
    window = _window(u, start, stop, lag)
    if window is None or abs(lag - (branch[0] - before[0])) > max(2.0, 0.1 * count):
        return None
    spread = float(np.median(np.abs(u[start:stop] - window)))
    return (start, stop, _nearly_whole(lag)) if spread <= tolerance else None


def _window(u: Array, start: int, stop: int, lag: float) -> Array | None:
    """Give the drive a lag before ``start`` to ``stop``; None where that is before the record."""
    reach = first_comparable(lag)
    return None if start < reach else earlier(u[start - reach : stop], lag)[0]


def _nearly_whole(lag: float) -> float:
    nearest = round(lag)
    return float(nearest) if abs(lag - nearest) < 0.02 else lag

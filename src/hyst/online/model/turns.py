"""The part of a past that a memory of return points keeps."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST = 400
"""Inputs that are kept. Beyond, the smallest loop that is still open counts as closed."""


def kept_turns(u: Iterable[float]) -> Array:
    """Give the inputs that leave the same memory: turning points, without loops that have closed.

    Parameters
    ----------
    u
        Inputs from the first sample on.

    Returns
    -------
    numpy.ndarray
        Shape (K,), at most 400; the last is the last input.

    Examples
    --------
    >>> kept_turns([0.0, 1.0, 3.0, 1.0, 2.0, -1.0])
    array([ 0.,  3., -1.])
    """
    kept: list[float] = []
    for each in u:
        if len(kept) > 1 and (each - kept[-1]) * (kept[-1] - kept[-2]) >= 0.0:
            kept[-1] = each
        else:
            kept.append(each)
        while len(kept) > 3 and _is_closed(*kept[-4:]):
            del kept[-3:-1]
    if len(kept) > MOST:
        kept = _without_smallest(kept)
    return np.array(kept)


def _is_closed(a: float, b: float, c: float, d: float) -> bool:
    return abs(c - b) <= min(abs(b - a), abs(d - c))


def _without_smallest(kept: list[float]) -> list[float]:
    while len(kept) > MOST:
        steps = np.abs(np.diff(kept))[1:-1]
        k = int(np.argmin(steps)) + 1
        del kept[k : k + 2]
    return kept

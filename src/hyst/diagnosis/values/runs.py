"""Stretches of samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Samples = NDArray[np.intp]
Runs = tuple[Samples, Samples]


def runs_where(true: NDArray[np.bool_]) -> Runs:
    """Give the first and the last sample of every stretch where something is true."""
    edges = np.diff(np.concatenate(([False], true, [False])).astype(np.int8))
    return np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1


def runs_of_equals(signal: NDArray[np.float64], shortest: int = 2) -> Runs:
    """Give the first and the last sample of every stretch on which a signal keeps one value.

    Parameters
    ----------
    signal
        Shape (N,).
    shortest
        How many samples a stretch has at least, >= 2.
    """
    first, last = runs_where(signal[1:] == signal[:-1])
    keep = last - first + 2 >= shortest
    return first[keep], last[keep] + 1


def samples_of(runs: Runs) -> Samples:
    """Give all samples of some runs, ascending."""
    parts = [np.arange(first, last + 1) for first, last in zip(*runs, strict=True)]
    return np.concatenate([np.empty(0, dtype=np.intp), *parts])

"""Counters that start again at zero when they are full."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_BITS = (8, 10, 12, 16, 20, 24, 30, 31, 32, 48, 63, 64)
# A counter of micro- or milliseconds may have been turned into other units before it was written.
_SCALES = (1.0, 1e-3, 1e-6, 1e-9)
_CLOCKS = (60.0, 3600.0, 86400.0, 86400e3, 86400e6, 1e3, 1e6, 1e9)
_NEAR = 0.5
_SAME_START = 2.0


@dataclass(frozen=True, eq=False)
class Wrapped:
    """A counter that was counted on.

    Parameters
    ----------
    time
        Stamps that increase, shape (N,).
    modulus
        Where the counter starts again.
    first
        Index of the first stamp after it did.
    times
        How often it did.
    """

    time: NDArray[np.float64]
    modulus: float
    first: int
    times: int


def counted_on(time: NDArray[np.float64]) -> Wrapped | None:
    """Count on where a counter wrapped.

    Parameters
    ----------
    time
        Time stamps, shape (N,).

    Returns
    -------
    Wrapped or None
        None unless every fall is a usual size of counters or clocks less one step, and the record
        does not fall to where it began: that would be another run as well.

    Examples
    --------
    >>> counted_on(np.array([65530.0, 65533.0, 0.0, 3.0, 6.0])).time.tolist()
    [65530.0, 65533.0, 65536.0, 65539.0, 65542.0]
    """
    gaps = np.diff(time)
    falls = np.flatnonzero(gaps < 0.0)
    rises = gaps[gaps > 0.0]
    if not falls.size or rises.size < falls.size or not np.isfinite(gaps).all():
        return None
    step = float(np.median(rises))
    if np.abs(time[falls + 1] - time[0]).min() < _SAME_START * step:
        return None
    powers = [2.0**bits * scale for bits in _BITS for scale in _SCALES]
    for modulus in (*powers, *_CLOCKS):
        near = np.abs(gaps[falls] + modulus - step) <= _NEAR * step
        if modulus > _SAME_START * step and near.all() and np.ptp(time) < modulus:
            turns = np.zeros(time.size)
            turns[falls + 1] = modulus
            return Wrapped(time + np.cumsum(turns), modulus, int(falls[0]) + 1, falls.size)
    return None

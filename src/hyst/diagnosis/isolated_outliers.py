"""Samples that stand out of their neighbours, bridged so that they decide nothing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

_TIMES = 6.0
"""How far beyond 99 % of the record's samples one must stand out of its neighbours."""

_STEPS = 3.0
"""How many of the largest usual steps from sample to sample, so that corners are no outliers."""


def isolated_outliers(y: Array) -> Flags:
    """Mark samples far from the median of the five around them."""
    if y.size < 5:
        return np.zeros(y.size, dtype=bool)
    padded = np.concatenate([y[:1], y[:1], y, y[-1:], y[-1:]])
    around = np.sort(np.lib.stride_tricks.sliding_window_view(padded, 5), axis=1)
    out = np.abs(y - around[:, 2])
    usual = float(np.quantile(out, 0.99))
    step = float(np.quantile(np.abs(np.diff(y)), 0.99))
    return np.asarray(out > max(_TIMES * usual, _STEPS * step))


def bridged(y: Array, kept: Flags) -> Array:
    """Draw lines over what is not kept."""
    places = np.flatnonzero(kept)
    if places.size in (0, y.size):
        return y
    return np.asarray(np.interp(np.arange(y.size), places, y[places]))

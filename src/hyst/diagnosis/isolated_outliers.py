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

_SOME = 20_000
"""Samples that tell what is usual."""


def isolated_outliers(y: Array) -> Flags:
    """Mark samples far from the median of the five around them.

    Parameters
    ----------
    y
        Shape (N,).
    """
    result = np.zeros(y.size, dtype=bool)
    if y.size < 5:
        return result
    some = np.arange(0, y.size, 1 + y.size // _SOME)
    usual = float(np.quantile(_standing_out(y, some), 0.99))
    step = np.abs(np.diff(y))
    usual_step = float(np.quantile(step[:: 1 + y.size // _SOME], 0.99))
    least = max(_TIMES * usual, _STEPS * usual_step)
    # The median is one of five, so what is far from it has a large step within two samples.
    large = np.flatnonzero(step > least / 4.0)
    places = np.unique(np.clip(large[:, None] + np.arange(-1, 3), 0, y.size - 1))
    result[places] = _standing_out(y, places) > least
    return result


def _standing_out(y: Array, places: NDArray[np.intp]) -> Array:
    around = np.clip(places[:, None] + np.arange(-2, 3), 0, y.size - 1)
    return np.asarray(np.abs(y[places] - np.median(y[around], axis=1)))


def bridged(y: Array, kept: Flags) -> Array:
    """Draw lines over what is not kept.

    Parameters
    ----------
    y
        Shape (N,).
    kept
        Shape (N,).
    """
    places = np.flatnonzero(kept)
    if places.size in (0, y.size):
        return y
    return np.asarray(np.interp(np.arange(y.size), places, y[places]))

"""The largest value of a function of frequency, from a grid and closed in on between its points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ROUNDS, _POINTS, _TOPS = 6, 21, 12


def largest(function: Callable[[Array], Array], w: Array) -> tuple[float, float]:
    """Give the largest value of a function of frequency and where it is, closed in on.

    Parameters
    ----------
    function
        Takes frequencies, shape (K,), and gives values of this shape.
    w
        The grid to start from, rising.

    Returns
    -------
    value, frequency : float
        Infinite where the function is not finite; at least 0.
    """
    values = np.asarray(function(w))
    if not np.isfinite(values).all():
        return np.inf, float(w[int(np.argmax(~np.isfinite(values)))])
    best, where = float(values.max()), float(w[int(values.argmax())])
    if best <= 0.0:
        return 0.0, where
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    tops = np.flatnonzero((values >= padded[:-2]) & (values >= padded[2:]) & (values > 0.8 * best))
    tops = tops[np.argsort(-values[tops])][:_TOPS]
    low, high = w[np.maximum(tops - 1, 0)], w[np.minimum(tops + 1, w.size - 1)]
    for _ in range(_ROUNDS):
        points = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _POINTS)
        found = np.asarray(function(points.ravel())).reshape(points.shape)
        index = found.argmax(axis=1)
        rows = np.arange(tops.size)
        if found.max() > best:
            row = int(found.max(axis=1).argmax())
            best, where = float(found[row, index[row]]), float(points[row, index[row]])
        low = points[rows, np.maximum(index - 1, 0)]
        high = points[rows, np.minimum(index + 1, _POINTS - 1)]
    return best, where

"""Fewer lags in the place of many on a grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def merged(
    weights: Array, tau: Array, count: int, bounds: tuple[float, float]
) -> tuple[Array, Array]:
    """Give so many lags that do about what more or fewer do.

    Neighbours nearest in decades are merged, to the sum of their weights and the weighted mean of
    the logarithms of their time constants; or the widest gap between two, or between one and the
    bounds, takes a further lag of little weight.

    Parameters
    ----------
    weights, tau
        Shape (n,), tau ascending, s.
    count
        How many to give.
    bounds
        Shortest and longest time constant, s.
    """
    w, logs = weights.astype(float), np.log(tau)
    while w.size > count:
        at = int(np.argmin(np.diff(logs)))
        both = w[at : at + 2]
        middle = float(both @ logs[at : at + 2] / both.sum())
        w = np.concatenate([w[:at], [both.sum()], w[at + 2 :]])
        logs = np.concatenate([logs[:at], [middle], logs[at + 2 :]])
    low, high = np.log(bounds)
    while w.size < count:
        edges = np.concatenate([[low], logs, [high]])
        at = int(np.argmax(np.diff(edges)))
        middle = 0.5 * (edges[at] + edges[at + 1])
        w = np.insert(w, at, 0.1 * (w.mean() if w.size else 0.05))
        logs = np.insert(logs, at, middle)
    return w, np.exp(logs)

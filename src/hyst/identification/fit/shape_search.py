"""Models that are linear but for one shape: a search for it, the rest by least squares."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.identification.fit.non_negative import non_negative

Array = NDArray[np.float64]

ROUNDING = 1e-24
"""Of the output's power."""

GRID = 48
DIPS = 4


def shares(matrix: Array, target: Array) -> tuple[Array, float]:
    """Give coefficients of columns, none negative, and the sum of squared residuals.

    Columns are scaled to each other; a few of them need no more than their QR factors.

    Parameters
    ----------
    matrix
        Shape (N, m), m few.
    target
        Shape (N,).

    Returns
    -------
    numpy.ndarray
        Shape (m,).
    float
    """
    scale = np.linalg.norm(matrix, axis=0)
    if not scale.all():
        return np.zeros(matrix.shape[1]), float(target @ target)
    q, r = np.linalg.qr(matrix / scale)
    moment = q.T @ target
    beyond = float(target @ target - moment @ moment)
    coefficients, residual = non_negative(r, moment)
    return coefficients / scale, max(beyond, 0.0) + residual**2


def least_over(cost: Callable[[float], float], low: float, high: float) -> tuple[float, int]:
    """Find the global minimum over a shape: a grid over its logarithm, then Brent's method in dips.

    Parameters
    ----------
    cost
        Of a shape.
    low, high
        Ends, positive.

    Returns
    -------
    float
        The shape.
    int
        How many were tried.
    """
    grid = np.geomspace(low, high, GRID)
    costs = np.array([cost(float(shape)) for shape in grid])
    evaluations = GRID
    best, least = float(grid[np.argmin(costs)]), float(costs.min())
    padded = np.concatenate([[np.inf], costs, [np.inf]])
    dips = np.flatnonzero((costs <= padded[:-2]) & (costs <= padded[2:]))
    for dip in dips[np.argsort(costs[dips])][:DIPS]:
        ends = grid[max(dip - 1, 0)], grid[min(dip + 1, GRID - 1)]
        found = scipy.optimize.minimize_scalar(
            lambda logarithm: cost(float(np.exp(logarithm))),
            bounds=(float(np.log(ends[0])), float(np.log(ends[1]))),
            method="bounded",
            options={"xatol": 1e-10},
        )
        evaluations += int(found.nfev)
        if found.fun < least:
            best, least = float(np.exp(found.x)), float(found.fun)
    return best, evaluations


def saved_beside_a_line(line: Array, target: Array, left: float) -> float:
    """Give the squared residual saved beside a line alone, in residual variances.

    Parameters
    ----------
    line
        Shape (N,), the centred input.
    target
        Shape (N,), the centred output.
    left
        Sum of squared residuals of the model.
    """
    power = float(target @ target)
    by_line = float(np.square(target - line * (float(line @ target) / float(line @ line))).sum())
    if by_line <= ROUNDING * power:
        return 0.0  # an exact line, and no shape saves more than rounding
    variance = left / max(target.size - 4, 1)
    return (by_line - left) / max(variance, float(np.finfo(np.float64).tiny))

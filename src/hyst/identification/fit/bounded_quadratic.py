"""Least of a quadratic within bounds, for hundreds of unknowns: block principal pivoting.

Every unknown is free or held on a bound. The free ones are solved for; those that leave their
bounds are held, and held ones whose gradient points inwards are set free, all at once. Where that
does not lower the number of such unknowns, only the last of them moves, which cannot go on for
ever.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import SolverError

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

PATIENCE = 3
"""Exchanges of all at once that may fail to lower the number of wrong unknowns."""

ROUNDING = 1e-11
"""Of an unknown beside the largest one, or of a gradient beside its parts: at first no more."""

RIDGE = 1e-12
"""Of the scaled matrix: it keeps what the data do not determine numerically definite."""

LOOSER, LOOSEST = 10.0, 1e-6
"""By how much rounding may be more after as many exchanges as there are unknowns, and the most: of
a matrix that determines little, exchanges within its rounding would go round for ever."""

MOST_EXCHANGES = 20
"""Times the number of unknowns."""


def least_within(normal: Array, moment: Array, lower: Array, upper: Array, first: Array) -> Array:
    """Minimise ``x' A x / 2 - b' x`` over ``lower <= x <= upper``.

    Parameters
    ----------
    normal
        A, shape (m, m), positive semidefinite.
    moment
        b, shape (m,).
    lower, upper
        Shape (m,); infinite where there is none.
    first
        Shape (m,): what lies on a bound there is held at first.

    Returns
    -------
    numpy.ndarray
        Shape (m,), within the bounds.

    Raises
    ------
    SolverError
        If it does not end.

    Notes
    -----
    Judice and Pires, Computers and Operations Research 21 (1994), 587-596.
    """
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-30 * max(float(np.diag(normal).max()), 1e-300)))
    a = normal / np.outer(scale, scale) + RIDGE * np.eye(scale.size)
    b, low, high = moment / scale, lower * scale, upper * scale
    side = np.where(first <= lower, -1, np.where(first >= upper, 1, 0))
    fewest, patience = side.size + 1, PATIENCE
    for number in range(MOST_EXCHANGES * (side.size + 1)):
        rounding = min(ROUNDING * LOOSER ** (number // (side.size + 1)), LOOSEST)
        x, wrong = _exchange(a, b, low, high, side, rounding)
        count = int(np.count_nonzero(wrong != side))
        if count == 0:
            # What is held lies on its bound to the last bit: others ask by comparing.
            free = np.clip(x / scale, lower, upper)
            return np.where(side < 0, lower, np.where(side > 0, upper, free))
        patience = PATIENCE if count < fewest else patience - 1
        fewest = min(fewest, count)
        if patience >= 0:
            side = wrong
        else:
            last = int(np.flatnonzero(wrong != side)[-1])
            side[last] = wrong[last]
    raise SolverError(
        f"the bounded least squares problem of {side.size} unknowns did not end; give fewer levels"
    )


def _exchange(
    a: Array, b: Array, low: Array, high: Array, side: NDArray[np.int_], rounding: float
) -> tuple[Array, NDArray[np.int_]]:
    """Solve for the free unknowns, and say on which side each of all should be: -1, 0 or 1."""
    free = side == 0
    x = np.where(free, 0.0, np.where(side < 0, low, high))
    x[~free] = np.where(np.isfinite(x[~free]), x[~free], 0.0)
    right = b[free] - a[np.ix_(free, ~free)] @ x[~free]
    if free.any():
        factor = scipy.linalg.cho_factor(a[np.ix_(free, free)], check_finite=False)
        x[free] = scipy.linalg.cho_solve(factor, right, check_finite=False)
    slack = rounding * float(np.abs(x).max(initial=0.0))
    should = np.zeros_like(side)
    should[free & (x < low - slack)] = -1
    should[free & (x > high + slack)] = 1
    gradient, parts = a @ x - b, np.abs(b) + np.abs(a) @ np.abs(x)
    pushed = np.abs(gradient) > rounding * parts
    should[(side < 0) & ~(pushed & (gradient < 0.0))] = -1
    should[(side > 0) & ~(pushed & (gradient > 0.0))] = 1
    return x, should

"""Slopes of a piecewise linear curve: partial sums of its weights."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def cumulative(first: float, weights: Array) -> Array:
    """Give the partial sums ``c_j = first + w_1 + .. + w_j``.

    Parameters
    ----------
    first
        Slope of the innermost piece.
    weights
        Shape (n,), what is added at each threshold outwards.

    Returns
    -------
    numpy.ndarray
        Shape (n + 1,), from ``c_0 = first`` on; an overflow gives an infinity or a NaN.

    Examples
    --------
    >>> cumulative(1.0, np.array([0.5, -0.25]))
    array([1.  , 1.5 , 1.25])
    """
    with np.errstate(all="ignore"):
        return first + np.concatenate([[0.0], np.cumsum(weights)])


def rounding_of_cumulative(first: float, weights: Array) -> Array:
    """Give how far rounding may have moved the partial sums.

    A cumulative weight smaller than that, as 0.1 + 0.2 - 0.3, is zero to all that is known.

    Parameters
    ----------
    first, weights
        As in ``cumulative``.

    Returns
    -------
    numpy.ndarray
        Shape (n + 1,): ``eps (|first| + |w_1| + .. + |w_j|)``, and 0 for the sum of no weight.

    Examples
    --------
    >>> bool(0.0 < 0.1 + 0.2 - 0.3 <= rounding_of_cumulative(0.1, np.array([0.2, -0.3]))[-1])
    True
    """
    bound = np.finfo(np.float64).eps * cumulative(abs(first), np.abs(weights))
    bound[0] = 0.0
    return bound

"""The grid of a Preisach model: what thresholds and masses of cells may be, and their order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, finite_array
from hyst.errors import InputError

Array = NDArray[np.float64]


def as_edges(thresholds: ArrayLike) -> Array:
    """Check the thresholds of a grid.

    Parameters
    ----------
    thresholds
        Shape (n + 1,), n >= 1, finite, ascending, input units.

    Returns
    -------
    numpy.ndarray
        A read-only float64 copy.

    Raises
    ------
    InputError
        If there are fewer than two, or one is not above the one before.
    """
    edges = as_constants(thresholds, "thresholds")
    if edges.size < 2:
        raise InputError(
            f"thresholds has {edges.size} entries; give the edges of the cells, one more than cells"
        )
    with np.errstate(over="ignore"):
        widths, span = np.diff(edges), edges[-1] - edges[0]
    wrong = np.flatnonzero(~(widths > 0.0))
    if wrong.size:
        i = int(wrong[0]) + 1
        raise InputError(
            f"thresholds[{i}] = {edges[i]:.6g} is not above thresholds[{i - 1}] = "
            f"{edges[i - 1]:.6g}; give edges that ascend"
        )
    if not np.isfinite(span):
        raise InputError(
            f"thresholds reach from {edges[0]:.6g} to {edges[-1]:.6g}, further apart than a number "
            "can say; choose another input unit"
        )
    return edges


def as_masses(weights: Any, edges: Array) -> Array:
    """Check the masses of the cells of a grid.

    Parameters
    ----------
    weights
        Shape (n, n), finite, >= 0, and 0 above the diagonal; or the rows of the lower triangle, of
        1, 2, .. n entries.
    edges
        Shape (n + 1,), as ``as_edges`` gives them.

    Returns
    -------
    numpy.ndarray
        A read-only float64 copy, shape (n, n).

    Raises
    ------
    InputError
        If the shape does not fit the thresholds, or a mass is negative or above the diagonal.
    """
    n = edges.size - 1
    given = _square(weights)
    if given.shape != (n, n):
        raise InputError(
            f"weights has shape {given.shape}; {edges.size} thresholds are the edges of {n} x {n} "
            "cells"
        )
    masses = given + 0.0
    above = np.argwhere(np.triu(masses, 1) != 0.0)
    if above.size:
        i, j = above[0].tolist()
        raise InputError(
            f"weights[{i}, {j}] is {masses[i, j]:.6g}; there beta would be above alpha, so give 0 "
            "above the diagonal"
        )
    negative = np.argwhere(masses < 0.0)
    if negative.size:
        i, j = negative[0].tolist()
        raise InputError(
            f"weights[{i}, {j}] is {masses[i, j]:.6g}; a negative density lets the output fall "
            "while the input rises, so give 0 or more"
        )
    with np.errstate(over="ignore"):
        if not np.isfinite(2.0 * masses.sum()):
            raise InputError("the sum of weights overflows; choose another output unit")
    masses.flags.writeable = False
    return masses


def lower_triangle(weights: Array) -> Array:
    """Give the entries on and below the diagonal, row by row."""
    return np.asarray(weights[np.tril_indices(weights.shape[0])])


def triangle(entries: Array, n: int) -> Array:
    """Give the matrix of n rows whose lower triangle has these entries, row by row."""
    weights = np.zeros((n, n))
    weights[np.tril_indices(n)] = entries
    return weights


def names_of_cells(n: int) -> tuple[str, ...]:
    """Give the names of the entries of the lower triangle, counted from 1 as in formulas."""
    return tuple(f"w[{i},{j}]" for i in range(1, n + 1) for j in range(1, i + 1))


def _square(weights: Any) -> Array:
    """Take a matrix, or the rows of a lower triangle as files hold them."""
    if isinstance(weights, list | tuple) and weights and _is_triangle(weights):
        n = len(weights)
        weights = [[*row, *[0.0] * (n - len(row))] for row in weights]
    return finite_array(weights, "weights")


def _is_triangle(rows: Any) -> bool:
    return all(isinstance(row, list | tuple) and len(row) == i + 1 for i, row in enumerate(rows))

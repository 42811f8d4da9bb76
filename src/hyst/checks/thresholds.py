"""Checks of the weights and thresholds of a bank of plays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.errors import InputError

Array = NDArray[np.float64]


def as_ascending_thresholds(values: ArrayLike, name: str = "r") -> Array:
    """Check the thresholds of a bank of plays: ``0 <= r_1 <= ... <= r_n``.

    Parameters
    ----------
    values
        Shape (n,), in units of the input.
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, read-only.

    Raises
    ------
    InputError
        If one is negative, smaller than the one before it, or not finite.
    """
    thresholds = as_constants(values, name)
    if thresholds.size and thresholds.min() < 0.0:
        bad = int(np.flatnonzero(thresholds < 0.0)[0])
        raise InputError(f"{name}[{bad}] is {thresholds[bad]}; thresholds are zero or positive")
    falling = np.flatnonzero(np.diff(thresholds) < 0.0)
    if falling.size:
        i = int(falling[0]) + 1
        raise InputError(
            f"{name}[{i}] = {thresholds[i]} is smaller than {name}[{i - 1}] = {thresholds[i - 1]}; "
            "sort the thresholds in ascending order, with their weights"
        )
    return thresholds


def as_weights_and_thresholds(p: ArrayLike, r: ArrayLike) -> tuple[Array, Array]:
    """Check the weights and thresholds of a bank of plays.

    Parameters
    ----------
    p
        Shape (n,), weights.
    r
        Shape (n,), thresholds, as of ``as_ascending_thresholds``.

    Returns
    -------
    tuple of numpy.ndarray
        Both float64, read-only.

    Raises
    ------
    InputError
        If the lengths differ, thresholds are negative or unsorted, or a constant is not finite.
    """
    weights, thresholds = as_constants(p, "p"), as_ascending_thresholds(r)
    if weights.size != thresholds.size:
        raise InputError(
            f"p has {weights.size} entries but r has {thresholds.size}; give one p for each r"
        )
    return weights, thresholds


def require_memory(z0: NDArray[np.float64], r: NDArray[np.float64]) -> None:
    """Refuse play outputs that no input leaves.

    Parameters
    ----------
    z0, r
        Shape (n,), play outputs and thresholds.

    Raises
    ------
    InputError
        If they are not as many, or neighbours are further apart than their thresholds.

    Examples
    --------
    >>> require_memory(np.array([0.0, 0.5]), np.array([1.0, 2.0]))
    """
    if z0.size != r.size:
        raise InputError(f"z0 has {z0.size} entries; give one for each of {r.size} plays")
    # What rounding may add to a memory that an earlier run has left.
    slack = 1e-12 * (np.abs(z0).max(initial=0.0) + np.abs(r).max(initial=0.0))
    apart = np.flatnonzero(np.abs(np.diff(z0)) > np.diff(r) + slack)
    if apart.size:
        i = int(apart[0])
        raise InputError(
            f"z0[{i}] and z0[{i + 1}] differ by {abs(z0[i + 1] - z0[i]):.6g}, their thresholds by "
            f"{r[i + 1] - r[i]:.6g} only; no input leaves such a memory"
        )

"""Checks of the matrices of a sampled block, and of its signals."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, as_signal
from hyst.errors import InputError

Array = NDArray[np.float64]


def as_matrix(values: ArrayLike, shape: tuple[int, int], name: str) -> Array:
    """Check a matrix.

    Parameters
    ----------
    values
        What was given.
    shape
        What follows from the number of states.
    name
        What messages call it.

    Raises
    ------
    InputError
        If it has another shape, or an entry is not finite.
    """
    if 0 in shape and np.asarray(values, dtype=object).size == 0:
        return np.zeros(shape)
    matrix = as_signal(values, name)
    if matrix.shape != shape:
        raise InputError(f"{name} has shape {matrix.shape}; C has {shape[0]} entries, give {shape}")
    matrix = matrix.copy()
    matrix.flags.writeable = False
    return matrix


def as_entries(values: ArrayLike, length: int, name: str) -> Array:
    """Check a row of numbers.

    Parameters
    ----------
    values
        What was given.
    length
        How many there must be.
    name
        What messages call it.

    Raises
    ------
    InputError
        If there are more or fewer, or one is not finite.
    """
    vector = as_constants(values, name)
    if vector.size != length:
        raise InputError(f"{name} has {vector.size} entries; give {length}")
    return vector


def two_records(y_ref: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Check reference and measured output.

    Parameters
    ----------
    y_ref, y
        Shape (N,) each, finite.

    Raises
    ------
    InputError
        If they are no two records of one length.
    """
    reference, output = as_signal(y_ref, "y_ref"), as_signal(y, "y")
    if reference.ndim != 1 or output.shape != reference.shape:
        raise InputError(
            f"y_ref has shape {reference.shape} and y {output.shape}; give one record of each, (N,)"
        )
    return reference, output


def refuse_overflow_at(sample: int) -> None:
    """Refuse a record that a block did not get through.

    Parameters
    ----------
    sample
        At which it stopped, or -1.

    Raises
    ------
    InputError
        If it stopped.
    """
    if sample >= 0:
        raise InputError(
            f"the drive overflows at sample {sample}; the controller by itself is unstable, or "
            "its inputs are too large"
        )

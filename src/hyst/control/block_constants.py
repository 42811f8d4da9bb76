"""Checks of the matrices of a sampled block."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, as_signal
from hyst.errors import InputError

Array = NDArray[np.float64]


def as_matrix(values: ArrayLike, shape: tuple[int, int], name: str) -> Array:
    """Check a matrix of a ``shape`` that follows from the number of states."""
    if 0 in shape and np.asarray(values, dtype=object).size == 0:
        return np.zeros(shape)
    matrix = as_signal(values, name)
    if matrix.shape != shape:
        raise InputError(f"{name} has shape {matrix.shape}; C has {shape[0]} entries, give {shape}")
    matrix = matrix.copy()
    matrix.flags.writeable = False
    return matrix


def as_entries(values: ArrayLike, length: int, name: str) -> Array:
    """Check a row of as many numbers as ``length`` says."""
    vector = as_constants(values, name)
    if vector.size != length:
        raise InputError(f"{name} has {vector.size} entries; give {length}")
    return vector

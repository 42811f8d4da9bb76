"""Checks of the matrices of a state space with one input and one output."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.errors import InputError

Array = NDArray[np.float64]

LARGEST_ORDER = 64
LARGEST_DELAY = 10**6  # every sample moves the whole delay line


def checked_matrices(
    A: ArrayLike, B: ArrayLike, C: ArrayLike, D: ArrayLike
) -> tuple[Array, Array, Array, float]:
    """Check A, B, C and D and give read-only copies: (n, n), (n,), (n,) and a number.

    Raises
    ------
    InputError
        If shapes do not fit, a number is not finite, or n is above ``LARGEST_ORDER``.
    """
    b, c, d = _as_vector(B, "B"), _as_vector(C, "C"), _as_vector(D, "D")
    a = _as_vector(A, "A")
    if a.size != b.size**2 or np.ndim(A) not in (1, 2) or c.size != b.size:
        raise InputError(
            f"A, B and C have the shapes {np.shape(A)}, {np.shape(B)} and {np.shape(C)}; give "
            "(n, n), (n,) and (n,)"
        )
    if b.size > LARGEST_ORDER:
        raise InputError(f"the order is {b.size}; it is at most {LARGEST_ORDER}")
    if d.size != 1:
        raise InputError(f"D has shape {np.shape(D)}; give one number")
    square = a.reshape(b.size, b.size)
    square.flags.writeable = False
    return square, b, c, float(d[0])


def _as_vector(values: ArrayLike, name: str) -> Array:
    try:
        flat = np.ravel(np.asarray(values))
    except ValueError:
        raise InputError(f"{name} is not a table of numbers; give rows of equal length") from None
    return as_constants(flat, name)

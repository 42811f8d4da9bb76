"""One door through which every signal enters: a checked, read-only float64 vector."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError


def finite_vector(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Copy ``values`` into a read-only float64 vector without a gap in it.

    Parameters
    ----------
    values
        The signal, shape (N,) with N >= 1, real and finite.
    name
        What to call the signal in an error.

    Returns
    -------
    numpy.ndarray
        A contiguous, read-only copy, shape (N,).

    Raises
    ------
    InputError
        If ``values`` is not numeric and real, not one-dimensional, empty, or has an element
        that is not finite (the first such index is named).

    Examples
    --------
    >>> finite_vector([1, 2.5], "u")
    array([1. , 2.5])
    """
    try:
        given = np.asarray(values)
    except ValueError as error:
        raise InputError(f"{name} is not a vector of numbers; give a one-dimensional array") from (
            error
        )
    if given.dtype.kind not in "biuf":
        raise InputError(f"{name} holds {given.dtype}, not real numbers; convert it to float first")
    if given.ndim != 1:
        raise InputError(
            f"{name} has shape {given.shape}; give a one-dimensional array, one value a sample"
        )
    if given.size == 0:
        raise InputError(f"{name} is empty; give at least one sample")
    vector = np.array(given, dtype=np.float64, order="C")
    finite = np.isfinite(vector)
    if not finite.all():
        first = int(np.argmin(finite))
        raise InputError(
            f"{name} is {vector[first]} at index {first}; remove or repair samples "
            "that are not finite"
        )
    vector.flags.writeable = False
    return vector


def same_length(first: NDArray[np.float64], second: NDArray[np.float64], names: str) -> None:
    """Refuse two signals of different length.

    Parameters
    ----------
    first, second
        Vectors, shape (N,).
    names
        What to call the two together in an error, such as ``"u and y"``.

    Raises
    ------
    InputError
        If the lengths differ.

    Examples
    --------
    >>> same_length(np.zeros(3), np.ones(3), "u and y")
    """
    if first.size != second.size:
        raise InputError(
            f"{names} have {first.size} and {second.size} samples; "
            "give one value of each for every sample"
        )

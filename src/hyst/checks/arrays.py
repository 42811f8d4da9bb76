"""Checks of arrays: signals, states, constants."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.errors import InputError, NotInvertibleError

Array = NDArray[np.float64]


def as_reals(values: Any, name: str) -> Array:
    """Check an array of real numbers, finite or not.

    Parameters
    ----------
    values
        Of any shape.
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, C-contiguous; ``values`` itself where it already is that.

    Raises
    ------
    InputError
        If it is masked, not rectangular or not real.
    """
    if np.ma.is_masked(values):
        first = np.argwhere(np.ma.getmaskarray(values))[0].tolist()
        where = f"index {first[0]}" if len(first) == 1 else f"index {tuple(first)}"
        raise InputError(f"{name} has masked entries, the first at {where}; give numbers only")
    try:
        array = np.asarray(values)
    except ValueError:
        raise InputError(
            f"{name} is not a rectangular array of numbers; give lists of equal length"
        ) from None
    if array.dtype.kind not in "fiub":
        raise InputError(f"{name} has dtype {array.dtype}; give real numbers")
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def as_signal(u: ArrayLike, name: str = "u", *, finite: bool = True) -> Array:
    """Check a signal and give it as contiguous float64.

    Parameters
    ----------
    u
        Shape (N,) or (batch, N), real, finite, N >= 1.
    name
        What messages call it.
    finite
        False leaves it to the engine, which looks while it works, to find what is not finite.

    Returns
    -------
    numpy.ndarray
        Float64, C-contiguous; ``u`` itself where it already is that.

    Raises
    ------
    InputError
        If it has another shape, is empty, is not real, or holds a number that is not finite; the
        first bad index is named.
    """
    signal = as_reals(u, name)
    if signal.ndim not in (1, 2):
        raise InputError(f"{name} has {signal.ndim} dimensions; give (N,) or (batch, N)")
    if signal.size == 0:
        raise InputError(f"{name} is empty; give at least one sample")
    if finite:
        _refuse_non_finite(signal, name)
    return signal


def one_record(u: ArrayLike, name: str = "u") -> Array:
    """Check one record, as ``as_signal`` does, and refuse a batch.

    Parameters
    ----------
    u
        Shape (N,), real, finite, N >= 1.
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, C-contiguous; ``u`` itself where it already is that.

    Raises
    ------
    InputError
        If it has another shape, is empty, is not real, or holds a number that is not finite; the
        first bad index is named.
    """
    signal = _one_dimensional(u, name)
    _refuse_non_finite(signal, name)
    return signal


def finite_vector(values: ArrayLike, name: str) -> Array:
    """Copy a measured signal into a read-only vector without a gap in it.

    Parameters
    ----------
    values
        Shape (N,), real, finite, N >= 1.
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, a contiguous, read-only copy, shape (N,).

    Raises
    ------
    InputError
        If it is not real, not one-dimensional, empty, or has a sample that is not finite; the first
        such index is named.

    Examples
    --------
    >>> finite_vector([1, 2.5], "u")
    array([1. , 2.5])
    """
    vector = _one_dimensional(values, name).copy()
    bad = _engine.first_non_finite(vector)
    if bad >= 0:
        raise InputError(
            f"{name} is {vector[bad]} at index {bad}; remove or repair samples that are not finite"
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


def finite_array(values: Any, name: str) -> Array:
    """Check an array of any shape and give a copy.

    Parameters
    ----------
    values
        Real and finite.
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, C-contiguous, fresh.

    Raises
    ------
    InputError
        If it is not rectangular, not real or not finite; the first bad index is named.
    """
    array = as_reals(values, name).copy()
    _refuse_non_finite(array, name)
    return array


def as_constants(values: ArrayLike, name: str) -> Array:
    """Check an array of constants and give a read-only copy.

    Parameters
    ----------
    values
        Shape (n,), real and finite; n may be 0.
    name
        What messages call it.

    Returns
    -------
    numpy.ndarray
        Float64, read-only.

    Raises
    ------
    InputError
        If it is not one-dimensional, not real or not finite.
    """
    constants = as_reals(values, name).copy()
    if constants.ndim != 1:
        raise InputError(f"{name} has shape {constants.shape}; give a list of numbers")
    _refuse_non_finite(constants, name)
    constants.flags.writeable = False
    return constants


def one_each(values: ArrayLike, count: int, name: str, each: str) -> Array:
    """Check one number for all, or one for each.

    Parameters
    ----------
    values
        A number, or shape (n,); finite.
    count
        n.
    name, each
        What messages call them, and each of what they are for.

    Returns
    -------
    numpy.ndarray
        Shape (n,).

    Raises
    ------
    InputError
        If they are not that many finite numbers.

    Examples
    --------
    >>> one_each(2.0, 3, "gain", "play")
    array([2., 2., 2.])
    """
    given = finite_array(values, name)
    if given.ndim == 0:
        return np.full(count, given)
    if given.shape != (count,):
        raise InputError(f"{name} has shape {given.shape}; give one number, or one for each {each}")
    return given


def as_state(state: ArrayLike, length: int, batch: int | None) -> Array:
    """Check a state and give a copy, one row per record of a batch.

    Parameters
    ----------
    state
        Shape (length,), or (batch, length); float64 exactly, so that nothing is converted silently.
    length
        State values of the operator.
    batch
        Number of records, or None for a single one.

    Returns
    -------
    numpy.ndarray
        A fresh (batch or 1, length) array.

    Raises
    ------
    InputError
        If shape or dtype are wrong or a value is not finite.
    """
    try:
        given = np.asarray(state)
    except ValueError:
        raise InputError("state is not a rectangular array; give float64 numbers") from None
    if given.dtype != np.float64 and given.size:
        raise InputError(f"state has dtype {given.dtype}; give float64")
    rows = 1 if batch is None else batch
    if given.shape != (length,) and (batch is None or given.shape != (batch, length)):
        expected = f"({length},)" if batch is None else f"({length},) or ({batch}, {length})"
        raise InputError(f"state has shape {given.shape}; this operator needs {expected}")
    _refuse_non_finite(given, "state")
    return np.array(np.broadcast_to(given, (rows, length)), dtype=np.float64, order="C")


def refuse_sample(array: Array, bad: int, name: str) -> NoReturn:
    """Refuse a number that is not finite, or that an operator does not leave finite.

    Parameters
    ----------
    array
        The array it was found in.
    bad
        Its index in the flattened array.
    name
        What messages call the array.

    Raises
    ------
    InputError
        Always.
    """
    index = tuple(int(i) for i in np.unravel_index(bad, array.shape))
    where = f"{name}[{index[0] if len(index) == 1 else index}]" if index else name
    if np.isfinite(array[index]):
        raise InputError(
            f"at {where} = {array[index]:.6g} the operator overflows; choose units in which "
            "signals and constants are of moderate size, and for an inverse outputs that its model "
            "can give"
        )
    raise InputError(f"{where} is {array[index]}; every number must be finite")


def refuse_overflow(*constants: Array | float) -> None:
    """Check that the constants of an inverse are numbers a double can hold.

    Parameters
    ----------
    constants
        Weights, thresholds, memory of the inverse.

    Raises
    ------
    NotInvertibleError
        If one of them has overflowed.
    """
    if not all(np.isfinite(each).all() for each in constants):
        raise NotInvertibleError(
            "a constant of the inverse is beyond the range of double precision; choose units in "
            "which weights and thresholds are of moderate size"
        )


def _refuse_non_finite(array: Array, name: str) -> None:
    bad = _engine.first_non_finite(np.ascontiguousarray(array).reshape(-1))
    if bad >= 0:
        refuse_sample(array, bad, name)


def _one_dimensional(values: ArrayLike, name: str) -> Array:
    signal = as_reals(values, name)
    if signal.ndim != 1:
        raise InputError(
            f"{name} has shape {signal.shape}; give one record, a one-dimensional array (N,)"
        )
    if signal.size == 0:
        raise InputError(f"{name} is empty; give at least one sample")
    return signal

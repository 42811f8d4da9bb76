"""Checks of what operators are given: signals, states, constants."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.errors import InputError, NotInvertibleError

Array = NDArray[np.float64]


def _as_real_array(values: Any, name: str) -> Array:
    if np.ma.is_masked(values):
        raise InputError(f"{name} has masked entries; give numbers only")
    try:
        array = np.asarray(values)
    except ValueError:
        raise InputError(
            f"{name} is not a rectangular array of numbers; give lists of equal length"
        ) from None
    if array.dtype.kind not in "fiub":
        raise InputError(f"{name} has dtype {array.dtype}; give real numbers")
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def _refuse_non_finite(array: Array, name: str) -> None:
    bad = _engine.first_non_finite(np.ascontiguousarray(array).reshape(-1))
    if bad >= 0:
        refuse_sample(array, bad, name)


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
    where = index[0] if len(index) == 1 else index
    if np.isfinite(array[index]):
        raise InputError(
            f"at {name}[{where}] = {array[index]:.6g} the operator overflows; choose units in "
            "which signals and constants are of moderate size"
        )
    raise InputError(f"{name}[{where}] is {array[index]}; every number must be finite")


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
    signal = _as_real_array(u, name)
    if signal.ndim not in (1, 2):
        raise InputError(f"{name} has {signal.ndim} dimensions; give (N,) or (batch, N)")
    if signal.size == 0:
        raise InputError(f"{name} is empty; give at least one sample")
    if finite:
        _refuse_non_finite(signal, name)
    return signal


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
    constants = _as_real_array(values, name).copy()
    if constants.ndim != 1:
        raise InputError(f"{name} has shape {constants.shape}; give a list of numbers")
    _refuse_non_finite(constants, name)
    constants.flags.writeable = False
    return constants


def as_number(value: Any, name: str) -> float:
    """Check one constant.

    Parameters
    ----------
    value
        A finite real number.
    name
        What messages call it.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If it is not a finite real number.
    """
    number = _as_real_array(value, name)
    if number.ndim != 0:
        raise InputError(f"{name} has shape {number.shape}; give one number")
    if not np.isfinite(number):
        raise InputError(f"{name} is {float(number)}; it must be finite")
    return float(number)


def as_whole_number(value: Any, name: str, least: int = 0, most: int | None = None) -> int:
    """Check a number of samples or of states.

    Parameters
    ----------
    value
        A whole number, at least ``least``.
    name
        What messages call it.
    least, most
        The smallest and the largest that are allowed.

    Returns
    -------
    int

    Raises
    ------
    InputError
        If it is something else.
    """
    number = as_number(value, name)
    if number < least or number != int(number):
        raise InputError(f"{name} is {value}; give a whole number, at least {least}")
    if most is not None and number > most:
        raise InputError(f"{name} is {value}; give at most {most}")
    return int(number)


def as_threshold(value: Any, name: str = "r") -> float:
    """Check the threshold of a play or a stop.

    Parameters
    ----------
    value
        A finite number >= 0, in units of the input.
    name
        What messages call it.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If it is negative or not a finite number.
    """
    threshold = as_number(value, name)
    if threshold < 0.0:
        raise InputError(f"{name} is {threshold}; a threshold is zero or positive")
    return threshold


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

"""Checks of what an estimator is given."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError
from hyst.signals import Record

Array = NDArray[np.float64]


def positive(value: float, name: str, what: str, infinite: bool = False) -> float:
    """Read a number above 0.

    Parameters
    ----------
    value
        The number.
    name, what
        What it is called, and what to give instead of a bad one.
    infinite
        Whether it may be infinite.

    Raises
    ------
    InputError
        If it is not.

    Examples
    --------
    >>> positive(2, "dt", "the sample time in seconds")
    2.0
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not number > 0.0 or (math.isinf(number) and not infinite):
        raise InputError(f"{name} is {value!r}; give {what}, above 0")
    return number


def not_negative(value: float, name: str) -> float:
    """Read a finite number of at least 0.

    Parameters
    ----------
    value
        The number.
    name
        What it is called.

    Raises
    ------
    InputError
        If it is not.

    Examples
    --------
    >>> not_negative(0, "dead_time")
    0.0
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not (math.isfinite(number) and number >= 0.0):
        raise InputError(f"{name} is {value!r}; give a finite number of at least 0")
    return number


def one_each(values: ArrayLike, count: int, name: str) -> Array:
    """Read one number for all or one for each play.

    Parameters
    ----------
    values
        A number, or shape (n,).
    count
        n.
    name
        What they are called.

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
    >>> one_each(2.0, 3, "gain")
    array([2., 2., 2.])
    """
    try:
        given = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {values!r}; give numbers") from None
    if given.ndim == 0:
        given = np.full(count, float(given))
    if given.shape != (count,):
        raise InputError(f"{name} has shape {given.shape}; give one number, or one for each play")
    if not np.isfinite(given).all():
        raise InputError(f"{name} has an entry that is not finite; give finite numbers")
    return given


def samples_of(record: Record, dt: float) -> tuple[Array, Array]:
    """Give the signals of a record made at the estimator's sample time.

    Parameters
    ----------
    record
        The record.
    dt
        Sample time of the estimator, seconds.

    Raises
    ------
    InputError
        If it has another sample time.

    Examples
    --------
    >>> samples_of(Record([1.0, 2.0], [0.0, 0.0], 0.1), 0.1)[0]
    array([1., 2.])
    """
    if not math.isclose(record.dt, dt, rel_tol=1e-9):
        raise InputError(
            f"the record has dt = {record.dt:.9g} s but the estimator was made for {dt:.9g} s; "
            "make one for this sample time, or resample the record"
        )
    return record.u, record.y


def patience_in_samples(patience: float | None, memory: float, dt: float) -> float:
    """Give the patience of an estimator in samples: what was asked for, its memory, or 10,000.

    Parameters
    ----------
    patience, memory, dt
        Seconds; ``patience`` may be left to the others.

    Raises
    ------
    InputError
        If it is not a number above 0.

    Examples
    --------
    >>> patience_in_samples(None, 5.0, 0.5)
    10.0
    """
    if patience is not None:
        return max(positive(patience, "patience", "seconds") / dt, 1.0)
    return max(memory / dt, 1.0) if math.isfinite(memory) else 1e4


def given_or(value: float | None, otherwise: float) -> float:
    """Give ``value``, or ``otherwise`` where there is none."""
    return otherwise if value is None else value


def finite_or_none(value: float) -> float | None:
    """Give None for an infinity, which JSON does not have."""
    return value if math.isfinite(value) else None

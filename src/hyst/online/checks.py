"""Checks of what an estimator is given."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

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


def number(value: float, name: str) -> float:
    """Read a number, finite or not.

    Parameters
    ----------
    value
        The number.
    name
        What it is called.

    Raises
    ------
    InputError
        If it is no number.

    Examples
    --------
    >>> number(1, "y_ref")
    1.0
    """
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {value!r}; give a number") from None


def sample(u: float, y: float) -> tuple[float, float]:
    """Read one sample.

    Parameters
    ----------
    u, y
        Numbers, finite or not.

    Raises
    ------
    InputError
        If one is no number.

    Examples
    --------
    >>> sample(1, 2.0)
    (1.0, 2.0)
    """
    try:
        return float(u), float(y)
    except (TypeError, ValueError):
        raise InputError(f"the sample is u = {u!r}, y = {y!r}; give two numbers") from None


def names_of(held: Iterable[str], known: Iterable[str]) -> list[str]:
    """Read names of parameters.

    Parameters
    ----------
    held
        Names; one name may come without a list.
    known
        Those there are.

    Returns
    -------
    list of str
        In alphabetical order.

    Raises
    ------
    InputError
        If it is no list of known names.

    Examples
    --------
    >>> names_of("p0", ("p0", "p[1]"))
    ['p0']
    """
    try:
        names = [held] if isinstance(held, str) else list(held)
    except TypeError:
        raise InputError(f"held is {held!r}; give a list of names of parameters") from None
    there = list(known)
    for name in names:
        if name not in there:
            raise InputError(f"held names {name!r}; there are {', '.join(there)}")
    return sorted(names)


def samples_of(record: Record, dt: float, every: int) -> tuple[Array, Array, Array]:
    """Give the signals of a record made at the estimator's sample time, and when rows are kept.

    Parameters
    ----------
    record
        The record.
    dt
        Sample time of the estimator, seconds.
    every
        A row is kept after every so many samples.

    Returns
    -------
    u, y : numpy.ndarray
        Shape (N,).
    time : numpy.ndarray
        Shape (N // every,), seconds since the first sample.

    Raises
    ------
    InputError
        If it is no record or has another sample time, or ``every`` is not a whole number above 0.

    Examples
    --------
    >>> samples_of(Record([1.0, 2.0], [0.0, 0.0], 0.1), 0.1, 2)[2]
    array([0.1])
    """
    if not isinstance(record, Record):
        raise InputError(
            f"record is a {type(record).__name__}; give a hyst.Record(u, y, dt), or one sample at "
            "a time to update"
        )
    if not math.isclose(record.dt, dt, rel_tol=1e-9):
        raise InputError(
            f"the record has dt = {record.dt:.9g} s but the estimator was made for {dt:.9g} s; "
            "make one for this sample time, or resample the record"
        )
    if isinstance(every, bool) or not isinstance(every, int) or every < 1:
        raise InputError(f"every is {every!r}; give a whole number of samples, 1 or more")
    rows = record.u.size // every
    return record.u, record.y, np.asarray(dt * (np.arange(1, rows + 1) * every - 1.0))


def patience_in_samples(patience: float | None, memory: float, dt: float) -> float:
    """Give the patience in whole samples: what was asked for, the memory, or 10,000.

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
        return max(float(round(positive(patience, "patience", "seconds") / dt)), 1.0)
    return max(float(round(memory / dt)), 1.0) if math.isfinite(memory) else 1e4


def given_or(value: float | None, otherwise: float) -> float:
    """Give ``value``, or ``otherwise`` where there is none."""
    return otherwise if value is None else value


def memory_or_none(memory: float) -> float | None:
    """Read a memory in seconds; None stands for an infinite one, which JSON does not have."""
    seconds = positive(memory, "memory", "seconds, or infinity", True)
    return seconds if math.isfinite(seconds) else None


def memory_from(settings: dict[str, Any]) -> float:
    """Take the memory out of saved settings, in seconds."""
    memory: float | None = settings.pop("memory")
    return math.inf if memory is None else memory

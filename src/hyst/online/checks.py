"""Checks of what an estimator is given."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive, whole_number
from hyst.errors import InputError
from hyst.signals import Record

Array = NDArray[np.float64]


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


def names_of(held: Iterable[str], known: Iterable[str], option: str = "held") -> list[str]:
    """Read names of parameters.

    Parameters
    ----------
    held
        Names; one name may come without a list.
    known
        Those there are.
    option
        What messages call the list.

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
        raise InputError(f"{option} is {held!r}; give a list of names of parameters") from None
    there = list(dict.fromkeys(known))
    for name in names:
        if name not in there:
            raise InputError(f"{option} names {name!r}; there are {', '.join(there)}")
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
    step = whole_number(every, "every", 1, more=" samples")
    rows = record.u.size // step
    return record.u, record.y, np.asarray(dt * (np.arange(1, rows + 1) * step - 1.0))


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
        return max(float(round(as_positive(patience, "patience", "seconds") / dt)), 1.0)
    return max(float(round(memory / dt)), 1.0) if math.isfinite(memory) else 1e4


def memory_or_none(memory: float) -> float | None:
    """Read a memory in seconds; None stands for an infinite one, which JSON does not have."""
    seconds = as_positive(memory, "memory", "seconds, or infinity", infinite=True)
    return seconds if math.isfinite(seconds) else None


def memory_from(settings: dict[str, Any]) -> float:
    """Take the memory out of saved settings, in seconds."""
    memory: float | None = settings.pop("memory")
    return math.inf if memory is None else memory

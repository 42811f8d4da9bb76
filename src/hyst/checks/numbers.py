"""Checks of one number: ``{name} is {value}; give {what is wanted}``."""

from __future__ import annotations

import math
import numbers
from typing import Any

import numpy as np

from hyst.errors import InputError

_MOST_SHOWN = 40  # characters of a value in a message


def as_number(value: Any, name: str) -> float:
    """Check one real number.

    Parameters
    ----------
    value
        A finite real number, or an array without dimensions that holds one. A truth value is none.
    name
        What messages call it.

    Raises
    ------
    InputError
        If it is something else.

    Examples
    --------
    >>> as_number(2, "gain")
    2.0
    """
    number = _real(value)
    if not math.isfinite(number):
        raise InputError(f"{name} is {said(value)}; give a finite number")
    return number


def as_positive(
    value: Any,
    name: str,
    what: str = "a finite number",
    *,
    most: float = math.inf,
    infinite: bool = False,
) -> float:
    """Check a number above 0.

    Parameters
    ----------
    value
        The number.
    name, what
        What messages call it, and what they ask for instead of a bad one.
    most
        The largest that is allowed.
    infinite
        Whether it may be infinite.

    Raises
    ------
    InputError
        If it is something else.

    Examples
    --------
    >>> as_positive(2, "window", "seconds")
    2.0
    """
    number = _real(value)
    if not 0.0 < number <= most or (math.isinf(number) and not infinite):
        end = "" if math.isinf(most) else f" and at most {most:g}"
        raise InputError(f"{name} is {said(value)}; give {what}, above 0{end}")
    return number


def as_not_negative(value: Any, name: str, what: str = "a finite number") -> float:
    """Check a finite number of at least 0.

    Parameters
    ----------
    value
        The number.
    name, what
        What messages call it, and what they ask for instead of a bad one.

    Raises
    ------
    InputError
        If it is something else.

    Examples
    --------
    >>> as_not_negative(0, "dead_time")
    0.0
    """
    number = _real(value)
    if not (math.isfinite(number) and number >= 0.0):
        raise InputError(f"{name} is {said(value)}; give {what}, 0 or more")
    return number


def as_sample_time(value: Any, name: str = "dt") -> float:
    """Check a sample time.

    Parameters
    ----------
    value
        Seconds, finite and above 0.
    name
        What messages call it.

    Raises
    ------
    InputError
        If it is something else.

    Examples
    --------
    >>> as_sample_time(0.001)
    0.001
    """
    return as_positive(value, name, "the time between samples in seconds")


def as_threshold(value: Any, name: str = "r") -> float:
    """Check the threshold of a play or a stop.

    Parameters
    ----------
    value
        A finite number >= 0, in units of the input.
    name
        What messages call it.

    Raises
    ------
    InputError
        If it is negative or not a finite number.

    Examples
    --------
    >>> as_threshold(0.5)
    0.5
    """
    threshold = as_number(value, name)
    if threshold < 0.0:
        raise InputError(f"{name} is {threshold}; a threshold is zero or positive")
    return threshold


def whole_number(value: Any, name: str, least: int, most: int | None = None, more: str = "") -> int:
    """Check a number that counts something.

    Parameters
    ----------
    value
        A whole number of an integer type, from ``least`` to ``most``. A truth value is none.
    name
        What messages call it.
    least, most
        Ends of the range; without ``most`` it has no end.
    more
        What messages add after the range: a unit, or a word that is taken in its place.

    Raises
    ------
    InputError
        If it is something else.

    Examples
    --------
    >>> whole_number(3, "plays", 1, 200, ", or 'auto'")
    3
    """
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or value < least or (most is not None and value > most):
        allowed = f", at least {least}" if most is None else f" from {least} to {most}"
        raise InputError(f"{name} is {said(value)}; give a whole number{allowed}{more}")
    return int(value)


def as_reading(value: Any, name: str) -> float:
    """Read a number that a sensor or a loop gives, finite or not; quick, for every sample passes.

    Parameters
    ----------
    value
        The number.
    name
        What messages call it.

    Raises
    ------
    InputError
        If it is no number.

    Examples
    --------
    >>> as_reading(1, "y_ref")
    1.0
    """
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} is {said(value)}; give a number") from None


def given_or(value: float | None, otherwise: float) -> float:
    """Give ``value``, or ``otherwise`` where there is none."""
    return otherwise if value is None else value


def said(value: Any) -> str:
    """Say a value as messages do: as Python writes it, on one line, and not too long.

    Examples
    --------
    >>> said(np.float64(0.5)), said("a")
    ('0.5', "'a'")
    """
    try:
        text = " ".join(repr(value.item() if isinstance(value, np.generic) else value).split())
    except ValueError:  # a whole number of more digits than Python writes
        text = f"a very large {type(value).__name__}"
    return text if len(text) <= _MOST_SHOWN else f"{text[: _MOST_SHOWN - 3]}..."


def _real(value: Any) -> float:
    """Give a real number as it is, and NaN for whatever is none."""
    if isinstance(value, bool):
        return math.nan
    if isinstance(value, numbers.Real):
        try:
            return float(value)
        except OverflowError:
            return math.nan
    if hasattr(value, "__array__") and not np.ma.is_masked(value):
        held = np.asarray(value)
        if held.ndim == 0 and held.dtype.kind in "fiu":
            return float(held)
    return math.nan

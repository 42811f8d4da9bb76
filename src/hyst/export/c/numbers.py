"""Numbers as C reads them back without losing a bit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from hyst.errors import InputError

Precision = Literal["double", "single"]
PRECISIONS: tuple[Precision, ...] = ("double", "single")
_PER_LINE = 4
_LEAST_NORMAL = 2.0**-126  # of single precision


def as_precision(precision: str) -> Precision:
    """Check the name of a precision.

    Parameters
    ----------
    precision
        "double" or "single".

    Returns
    -------
    str

    Raises
    ------
    InputError
        If it is another.
    """
    for each in PRECISIONS:
        if precision == each:
            return each
    raise InputError(f"precision is {precision!r}; give double or single")


def rounded(value: float, precision: Precision, name: str) -> float:
    """Give the number that the target holds for a constant.

    Parameters
    ----------
    value
        Finite.
    precision
        Of the target.
    name
        What messages call the constant.

    Raises
    ------
    InputError
        If it is not finite, or is too large for single precision.
    """
    if not math.isfinite(value):
        raise InputError(f"{name} is {value}; a target needs finite constants, so scale the model")
    if precision == "double":
        return value
    with np.errstate(over="ignore", under="ignore"):
        number = float(np.float32(value))
    if not math.isfinite(number):
        raise InputError(
            f"{name} is {value:.6g}, beyond single precision; export double, or scale the model"
        )
    return number


def refuse_vanishing(values: Sequence[float], precision: Precision, name: str) -> None:
    """Refuse constants that single precision would make 0, or nearly.

    Parameters
    ----------
    values
        At least one; beside larger ones a tiny one may vanish.
    precision
        Of the target.
    name
        What messages call them.

    Raises
    ------
    InputError
        If the largest is not 0 but below the normal numbers of single precision.
    """
    largest = max(abs(value) for value in values)
    if precision == "single" and 0.0 < largest < _LEAST_NORMAL:
        raise InputError(
            f"{name} is {largest:.6g} at most, below what single precision holds; export double, "
            "or scale the model"
        )


def literal(value: float, precision: Precision, name: str) -> str:
    """Give a constant as a hexadecimal floating literal, the shortest that is exact.

    Parameters
    ----------
    value, precision, name
        As in ``rounded``.

    Returns
    -------
    str

    Raises
    ------
    InputError
        As ``rounded``.

    Examples
    --------
    >>> literal(0.1, "double", "p0"), literal(-2.0, "single", "p0")
    ('0x1.999999999999ap-4', '-0x1p+1f')
    """
    return _written(rounded(value, precision, name), precision)


def _written(number: float, precision: Precision) -> str:
    mantissa, exponent = number.hex().split("p")
    mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    # "-0x0.0" would lose its only digit.
    mantissa = f"{mantissa}0" if mantissa.endswith("x") else mantissa
    return f"{mantissa}p{exponent}{'f' if precision == 'single' else ''}"


def table(values: Sequence[float], precision: Precision, name: str) -> str:
    """Give the initialiser of an array, a few literals a line.

    Parameters
    ----------
    values
        At least one.
    precision, name
        As in ``rounded``.

    Returns
    -------
    str
        In braces.

    Raises
    ------
    InputError
        As ``rounded``; the place is named.
    """
    texts = [_written(number, precision) for number in _all_rounded(values, precision, name)]
    lines = [", ".join(texts[i : i + _PER_LINE]) for i in range(0, len(texts), _PER_LINE)]
    return "{\n    " + ",\n    ".join(lines) + "}"


def _all_rounded(values: Sequence[float], precision: Precision, name: str) -> list[float]:
    """As ``rounded``, at once: self-tests have tables of ten thousand numbers."""
    numbers = np.asarray(values, dtype=np.float64)
    if precision == "single":
        with np.errstate(over="ignore", under="ignore"):
            numbers = numbers.astype(np.float32).astype(np.float64)
    if np.isfinite(numbers).all():
        result: list[float] = numbers.tolist()
        return result
    return [rounded(value, precision, f"{name}[{i}]") for i, value in enumerate(values)]

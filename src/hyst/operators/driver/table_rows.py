"""What a driver's table must be: checked row by row, so that the first bad one is named."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import as_reals
from hyst.errors import InputError
from hyst.operators.driver.points import Points

MOST_ROWS = 65536
_LARGEST = 1e300
_RESOLVED = (
    4.0  # roundings of the largest volt: a code's volts have two of them, its neighbour's too
)


def as_rows(codes: Any, volts: Any) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """Check a table and give it with rising codes.

    Parameters
    ----------
    codes, volts
        A row each, as given.

    Raises
    ------
    InputError
        If they are no table; the first bad row is named, counted from 1.
    """
    given, values = as_reals(codes, "codes"), as_reals(volts, "volts")
    if given.ndim != 1 or given.shape != values.shape:
        raise InputError(
            f"the driver's table has codes of shape {given.shape} and volts of shape "
            f"{values.shape}; give two lists of the same length"
        )
    if not 2 <= given.size <= MOST_ROWS:
        raise InputError(
            f"the driver's table has {given.size} rows; give 2 to {MOST_ROWS}, volts between them "
            "are a straight line in the code"
        )
    _refuse(given != np.floor(given), "code", given, "codes are whole numbers")
    _refuse((given < -(2.0**31)) | (given >= 2.0**31), "code", given, "codes are of 32 bits")
    _refuse(~np.isfinite(values), "volt", values, "give finite volts")
    # So that the way from volt to volt is a number, too.
    _refuse(abs(values) > _LARGEST, "volt", values, "give volts of moderate size")
    _refuse_turns(given, "code")
    _refuse_turns(values, "volt")
    order = slice(None) if given[1] > given[0] else slice(None, None, -1)
    whole = tuple(int(each) for each in given[order])
    return whole, tuple(values[order].tolist())


def as_ends(limits: Any) -> tuple[float, float]:
    """Check that limits are two numbers, either of which may be infinite.

    Parameters
    ----------
    limits
        As given.

    Raises
    ------
    InputError
        If they are something else.
    """
    try:
        low, high = (as_reals(each, "a limit") for each in limits)
    except (TypeError, ValueError):
        raise InputError(f"limits is {limits!r}; give the lowest and the highest volts") from None
    if low.ndim or high.ndim or np.isnan(low) or np.isnan(high):
        raise InputError(f"limits is {limits!r}; give the lowest and the highest volts")
    return float(low), float(high)


def unresolved_row(points: Points) -> int | None:
    """Give the first piece whose volts move too little from code to code; None if there is none."""
    kind = np.finfo(points.volts.dtype)
    # Below its least normal number a precision has fewer digits.
    least = max(_RESOLVED * float(kind.eps) * float(abs(points.volts).max()), float(kind.tiny))
    small = ~(abs(points.slopes).astype(np.float64) >= least)
    return int(small.argmax()) if small.any() else None


def _refuse(wrong: NDArray[np.bool_], name: str, values: NDArray[np.float64], why: str) -> None:
    if wrong.any():
        row = int(wrong.argmax())
        raise InputError(
            f"row {row + 1} of the driver's table has the {name} {values[row]:.17g}; {why}"
        )


def _refuse_turns(values: NDArray[np.float64], name: str) -> None:
    """Refuse what is there twice or turns back."""
    ways = np.sign(values[1:] - values[:-1])
    wrong = (ways == 0.0) | (ways != ways[0])
    if not wrong.any():
        return
    row = int(wrong.argmax()) + 1
    again = f"again, as in row {row}" if ways[row - 1] == 0.0 else f"after {values[row - 1]:.17g}"
    raise InputError(
        f"row {row + 1} of the driver's table has the {name} {values[row]:.17g} {again}; {name}s "
        "must rise or fall all the way"
    )

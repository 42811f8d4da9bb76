"""Production limits: what is allowed of a quantity, and which devices keep to it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

from hyst.errors import InputError
from hyst.fleet.quantities import PARAMETER, QUANTITIES

Limits = dict[str, tuple[float | None, float | None]]

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NAME = r"[^<>=]*[^<>=\s]"
_UPPER = re.compile(rf"\s*(?:({_NUMBER})\s*<=?)?\s*({_NAME})\s*<=?\s*({_NUMBER})\s*")
_LOWER = re.compile(rf"\s*({_NAME})\s*>=?\s*({_NUMBER})\s*")


def parse_limit(text: str) -> Limits:
    """Read one limit as it is typed.

    Parameters
    ----------
    text
        ``"rms_percent<0.5"``, ``"gain>0.9"`` or ``"0.9<gain<1.1"``; the ends are allowed.

    Returns
    -------
    dict
        Lowest and highest value by the name of the quantity, None where there is none.

    Raises
    ------
    InputError
        If it is none of these, or the quantity is not known.

    Examples
    --------
    >>> parse_limit("0.9<gain<1.1"), parse_limit("gain>0.9")
    ({'gain': (0.9, 1.1)}, {'gain': (0.9, None)})
    """
    if upper := _UPPER.fullmatch(text):
        low, name, high = upper.groups()
        return as_limits({name: (None if low is None else float(low), float(high))})
    if lower := _LOWER.fullmatch(text):
        return as_limits({lower[1]: (float(lower[2]), None)})
    raise InputError(
        f"the limit {text!r} is not understood; give it as rms_percent<0.5, gain>0.9 or "
        "0.9<gain<1.1"
    )


def as_limits(limits: Mapping[str, Any] | None, what: str = "limits") -> Limits:
    """Check limits.

    Parameters
    ----------
    limits
        By the name of a quantity, or of a parameter as ``"parameter NAME"``: a pair of lowest and
        highest value, None where there is none; or a mapping with ``min``, ``max`` or both.
    what
        What messages call them.

    Returns
    -------
    dict
        Pairs by name.

    Raises
    ------
    InputError
        If a quantity is not known, or a pair is no pair of numbers in order.

    Examples
    --------
    >>> as_limits({"rms_percent": {"max": 0.5}})
    {'rms_percent': (None, 0.5)}
    """
    if limits is None:
        return {}
    if not isinstance(limits, Mapping):
        raise InputError(f"{what} are of type {type(limits).__name__}; give them by quantity")
    return {name: _pair(name, pair, what) for name, pair in limits.items()}


def _pair(name: Any, pair: Any, what: str) -> tuple[float | None, float | None]:
    known = isinstance(name, str) and (name in QUANTITIES or name.startswith(PARAMETER))
    if not known:
        raise InputError(
            f"{what} name {name!r}, which is no quantity; choose among {', '.join(QUANTITIES)}, or "
            f"'{PARAMETER}NAME'"
        )
    if isinstance(pair, Mapping):
        if not pair or set(pair) - {"min", "max"}:
            raise InputError(f"{what} of {name} have {sorted(pair)}; give min, max or both")
        pair = (pair.get("min"), pair.get("max"))
    if not isinstance(pair, tuple | list) or len(pair) != 2:
        raise InputError(f"{what} of {name} are {pair!r}; give lowest and highest value")
    low, high = (_number(name, each, what) for each in pair)
    if low is None and high is None:
        raise InputError(f"{what} of {name} are empty; give a lowest or a highest value")
    if low is not None and high is not None and low > high:
        raise InputError(f"{what} of {name} are {low:g} to {high:g}; give the lower one first")
    return low, high


def _number(name: str, value: Any, what: str) -> float | None:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(f"{what} of {name} hold {value!r}; give finite numbers")
    return float(value)


def broken_limits(
    numbers: Mapping[str, float], limits: Mapping[str, tuple[float | None, float | None]]
) -> tuple[str, ...]:
    """Give a sentence for every limit that the numbers of a device do not keep.

    Parameters
    ----------
    numbers
        By name; what is not there keeps no limit.
    limits
        Checked.
    """
    told = []
    for name, (low, high) in limits.items():
        value = numbers.get(name, math.nan)
        if math.isnan(value):
            told.append(f"{name} is not known")
        elif low is not None and value < low:
            told.append(f"{name} {value:.4g} is below {low:g}")
        elif high is not None and value > high:
            told.append(f"{name} {value:.4g} is above {high:g}")
    return tuple(told)

"""Values as JSON has them: what a description keeps, and what it refuses."""

from __future__ import annotations

import dataclasses
import math
import numbers
import re
from collections.abc import Mapping
from typing import Any, NoReturn

import numpy as np

from hyst.errors import InputError


def as_text(name: str, value: Any) -> str:
    """Give a ``value`` that is text UTF-8 can write; ``name`` is what a refusal calls it."""
    # A lone surrogate cannot be written as UTF-8.
    if not isinstance(value, str) or re.search("[\ud800-\udfff]", value):
        _refuse(name, value, "text")
    return value


def as_finite(name: str, value: Any) -> float:
    """Give a ``value`` that is a finite number; ``name`` is what a refusal calls it."""
    if not _is_real(value) or not math.isfinite(value):
        _refuse(name, value, "a finite number")
    return float(value)


def as_finite_or_none(name: str, value: Any) -> float | None:
    """Give a ``value`` that is None or a finite number; ``name`` is what a refusal calls it."""
    return None if value is None else as_finite(name, value)


def as_number(name: str, value: Any) -> float:
    """Give a finite ``value``, a whole one as an int; ``name`` is what a refusal calls it."""
    number = as_finite(name, value)
    return int(number) if number.is_integer() else number


def as_finite_pair_or_none(name: str, value: Any) -> tuple[float, float] | None:
    """Give None, or two finite numbers of which the lower comes first.

    Parameters
    ----------
    name
        What messages call it.
    value
        None or a list of two numbers.

    Raises
    ------
    InputError
        If it is something else, or the higher number comes first.
    """
    if value is None:
        return None
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, list | tuple) or len(value) != 2:
        _refuse(name, value, "two numbers, the lower one first")
    low, high = (as_number(name, each) for each in value)
    if low > high:
        _refuse(name, value, "the lower number first")
    return low, high


def as_mapping(name: str, value: Any) -> dict[str, Any]:
    """Give a ``value`` with names as keys as a dictionary; ``name`` is what a refusal calls it."""
    if not isinstance(value, Mapping):
        _refuse(name, value, "a mapping of names to values")
    return {as_text(f"a name in {name}", key): each for key, each in value.items()}


def _is_real(value: Any) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def _refuse(name: str, value: Any, wanted: str) -> NoReturn:
    raise InputError(f"{name} is {value!r}; give {wanted}")


def as_plain(name: str, value: Any) -> Any:
    """Give a value of JSON: numbers finite, arrays as lists, data classes as mappings.

    Parameters
    ----------
    name
        What messages call it.
    value
        None, truth values, numbers, text, and lists, arrays, mappings and data classes of them.

    Raises
    ------
    InputError
        If it is something else, or holds a number that is not finite.
    """
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, str):
        return as_text(name, value)
    if isinstance(value, np.ndarray | np.generic):
        return as_plain(name, value.tolist())
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        return as_finite(name, value)
    if isinstance(value, list | tuple):
        return [as_plain(f"{name}[{index}]", each) for index, each in enumerate(value)]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {each.name: getattr(value, each.name) for each in dataclasses.fields(value)}
        return {"kind": type(value).__name__, **as_plain(name, fields)}
    return {key: as_plain(f"{name}.{key}", each) for key, each in as_mapping(name, value).items()}

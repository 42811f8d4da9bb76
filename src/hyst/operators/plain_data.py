"""Values as JSON has them: what a description keeps, and what it refuses."""

from __future__ import annotations

import dataclasses
import math
import numbers
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from hyst.errors import InputError


def as_text(name: str, value: Any) -> str:
    """Give a text that UTF-8 can write; refuse anything else under ``name``."""
    # A lone surrogate cannot be written as UTF-8.
    if isinstance(value, str) and not re.search("[\ud800-\udfff]", value):
        return value
    raise InputError(f"{name} is {value!r}; give text")


def as_finite(name: str, value: Any) -> float:
    """Give a finite number as a float; refuse anything else under ``name``."""
    if not isinstance(value, bool) and isinstance(value, numbers.Real):
        number = float(value)
        if math.isfinite(number):
            return number
    raise InputError(f"{name} is {value!r}; give a finite number")


def as_finite_or_none(name: str, value: Any) -> float | None:
    """Give a finite number, or None as it is; refuse anything else under ``name``."""
    return None if value is None else as_finite(name, value)


def as_whole(name: str, value: Any) -> int:
    """Give a whole number as an int; refuse anything else under ``name``."""
    if not isinstance(value, bool) and isinstance(value, numbers.Real):
        number = float(value)
        if number.is_integer():
            return int(number)
    raise InputError(f"{name} is {value!r}; give a whole number")


def as_mapping(name: str, value: Any) -> dict[str, Any]:
    """Give a mapping with names as keys as a new dictionary; refuse anything else."""
    if not isinstance(value, Mapping):
        raise InputError(f"{name} is {value!r}; give a mapping of names to values")
    return {as_text(f"a name in {name}", key): each for key, each in value.items()}


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

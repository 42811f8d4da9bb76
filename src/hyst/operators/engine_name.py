"""The engines that evaluate records, by name."""

from __future__ import annotations

from typing import Literal, SupportsIndex, TypeAlias, get_args

from hyst.checks.numbers import whole_number
from hyst.errors import InputError

EngineName: TypeAlias = Literal["auto", "loop", "lanes", "memory-curve"]


def as_engine(name: str) -> str:
    """Check the name of an engine.

    Parameters
    ----------
    name
        One of ``EngineName``.

    Returns
    -------
    str
        ``name`` itself.

    Raises
    ------
    InputError
        If there is no such engine.
    """
    if name not in get_args(EngineName):
        raise InputError(f"engine is {name!r}; give one of {', '.join(get_args(EngineName))}")
    return name


def as_threads(count: SupportsIndex) -> int:
    """Check a number of threads.

    Parameters
    ----------
    count
        1 to 1024.

    Returns
    -------
    int
        ``count`` itself.

    Raises
    ------
    InputError
        If it is no whole number from 1 to 1024.
    """
    return whole_number(count, "threads", 1, 1024)

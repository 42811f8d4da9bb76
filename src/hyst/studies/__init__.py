"""Studies: one module a paper, its figures and tables, printed numbers beside computed ones.

A module is named ``s`` and the number of its source, then what it is about. It has ``TITLE``,
``tables()`` and ``figures()``.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hyst.errors import InputError

if TYPE_CHECKING:
    from hyst.report import Table

__all__ = ["Study", "keys", "study"]

_NAME = re.compile(r"(s\d+)_\w+")


@dataclass(frozen=True)
class Study:
    """One paper worked through.

    Parameters
    ----------
    key
        ``s3`` and so on.
    title
        Of the paper's subject.
    tables
        Computes the tables.
    figures
        Draws the figures: PNG by file name.
    """

    key: str
    title: str
    tables: Callable[[], tuple[Table, ...]]
    figures: Callable[[], dict[str, bytes]]


def keys() -> tuple[str, ...]:
    """Give the keys of all studies there are, sorted.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> "s3" in keys()
    True
    """
    return tuple(sorted(_modules()))


def study(key: str) -> Study:
    """Give a study.

    Parameters
    ----------
    key
        One of ``keys()``.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        If there is none of this key.

    Examples
    --------
    >>> study("s3").key
    's3'
    """
    modules = _modules()
    if key not in modules:
        raise InputError(f"there is no study {key!r}; choose one of {', '.join(keys())}, or all")
    module = importlib.import_module(f"{__name__}.{modules[key]}")
    return Study(key, module.TITLE, module.tables, module.figures)


def _modules() -> dict[str, str]:
    names = (each.name for each in pkgutil.iter_modules(__path__))
    return {found.group(1): name for name in names if (found := _NAME.fullmatch(name))}


def __dir__() -> list[str]:
    return __all__

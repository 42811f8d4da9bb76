"""Studies: one module a paper, its figures and tables, printed numbers beside computed ones.

A module is named ``s`` and the number of its source, then what it is about. It has ``TITLE``,
``tables()`` and ``figures()``, and may have ``on_record(record, validation, delay)``: what of the
paper can be told of a record of one's own. A part of a study is in its package or named otherwise.
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
    from hyst.signals import Record

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
    on_record
        Computes tables of a record, of a second one for validation or None, and of the output's lag
        in samples or None; if the study can.
    """

    key: str
    title: str
    tables: Callable[[], tuple[Table, ...]]
    figures: Callable[[], dict[str, bytes]]
    on_record: Callable[[Record, Record | None, float | None], tuple[Table, ...]] | None = None


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
    told = getattr(module, "on_record", None)
    return Study(key, module.TITLE, module.tables, module.figures, told)


def _modules() -> dict[str, str]:
    names = (each.name for each in pkgutil.iter_modules(__path__))
    return {found.group(1): name for name in names if (found := _NAME.fullmatch(name))}


def __dir__() -> list[str]:
    return __all__

"""Choose a column of a table by header, name or index."""

from __future__ import annotations

import operator
from collections.abc import Sequence

from hyst.errors import InputError
from hyst.io.header import split_unit
from hyst.io.table import Table

_LISTED = 12
_SHOWN = 40


def find_column(table: Table, column: int | str) -> int:
    """Find the index of a column.

    Tried in this order: the full header (``voltage [V]``), the name without its unit
    (``voltage``), the same two ignoring case, other rows of names above the columns, a unit, and
    last a string of digits as an index.

    Parameters
    ----------
    table
        Where to look.
    column
        Header, name, or 0-based index.

    Returns
    -------
    int
        0-based index.

    Raises
    ------
    InputError
        If there is no such column (those there are get listed) or more than one.

    Examples
    --------
    >>> import numpy as np
    >>> names, zeros = ("Drive", "stroke"), np.zeros(2)
    >>> table = Table("a.npz", names, ("", ""), (zeros, zeros), names, (None, None))
    >>> find_column(table, "drive"), find_column(table, "1"), find_column(table, 1)
    (0, 1, 1)
    """
    if not isinstance(column, str):
        return _by_index(table, column)
    wanted = column.strip()
    folded = wanted.casefold()
    for matches in (
        [k for k, header in enumerate(table.headers) if header == wanted],
        [k for k, name in enumerate(table.names) if name == wanted],
        [k for k, header in enumerate(table.headers) if header.casefold() == folded],
        [k for k, name in enumerate(table.names) if name.casefold() == folded],
        [k for k, name in enumerate(table.names) if (name, table.units[k]) == split_unit(wanted)],
        *([k for k, each in enumerate(row) if each.casefold() == folded] for row in table.aliases),
        [k for k, unit in enumerate(table.units) if unit and unit == wanted],
    ):
        if len(matches) == 1:
            return matches[0]
        if matches:
            which = " and ".join(str(k) for k in matches[:_LISTED])
            raise InputError(
                f"{table.source}: {wanted!r} fits the columns {which}; "
                "give the full header or the index"
            )
    if wanted.isascii() and wanted.isdigit():
        return _by_index(table, int(wanted[:18]))
    for name, reason in table.left_out.items():
        # What is inside an object is asked for by its name and more.
        if folded == name.casefold() or folded.startswith(
            tuple(name.casefold() + c for c in "./({")
        ):
            raise InputError(f"{table.source}: {shorten(name)} {reason}")
    raise InputError(f"{table.source} has no column {shorten(wanted)}; there are {_listed(table)}")


def refuse_flaws(table: Table, column: int, remedy: str) -> None:
    """Refuse a column that holds something other than finite numbers.

    Parameters
    ----------
    table, column
        Where to look, and the 0-based index.
    remedy
        What to do about it, for the message.

    Raises
    ------
    InputError
        If the column has a flaw; its first line or index and its text are named.
    """
    flaw = table.flaws[column]
    if flaw is None:
        return
    name, place = table.names[column], table.place(flaw.row)
    if not flaw.text:
        raise InputError(f"{table.source}: {name!r} has no value at {place}; {remedy}")
    if flaw.why:
        raise InputError(f"{table.source}: {name!r} is {shorten(flaw.text)} at {place}, {flaw.why}")
    raise InputError(
        f"{table.source}: {name!r} is {shorten(flaw.text)} at {place}, not a finite number; "
        f"{remedy}"
    )


def refuse_doubts(table: Table, column: int) -> None:
    """Refuse a signal, a column of a table, whose unit the file contradicts.

    Raises
    ------
    InputError
        If so.
    """
    if column in table.doubts:
        name = table.names[column]
        raise InputError(f"{table.source}: {name!r}: {table.doubts[column]}; correct one")


def notes_about(table: Table, columns: Sequence[int]) -> tuple[str, ...]:
    """Give what is to be told about a table and some of its columns."""
    of_columns = (
        f"{table.names[k]!r}: {note}" for k in columns for note in table.notes_of_columns.get(k, ())
    )
    return (*table.notes, *of_columns)


def shorten(text: str) -> str:
    """Quote a text from a file, cut to a length that fits a message."""
    return repr(text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "...")


def _by_index(table: Table, column: int) -> int:
    try:
        index = operator.index(column)
    except TypeError:
        index = -1
    if isinstance(column, bool) or not 0 <= index < len(table.columns):
        raise InputError(
            f"{table.source} has no column {column!r}; there are {len(table.columns)}, "
            f"counted from 0: {_listed(table)}"
        )
    return index


def _listed(table: Table) -> str:
    shown = ", ".join(header[:_SHOWN] for header in table.headers[:_LISTED])
    more = len(table.headers) - _LISTED
    return shown if more <= 0 else f"{shown} and {more} more"

"""What every file format is read into: named columns of numbers, with their units as text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Flaw:
    """The first entry of a column that is not a finite number.

    Parameters
    ----------
    row
        Its index in the column.
    text
        How it is written in the file; empty when there is nothing.
    why
        What is wrong with it and what to do, where that is known; then the whole column cannot be
        read, and leaving rows out is no remedy.
    """

    row: int
    text: str
    why: str = ""


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of a data file.

    Parameters
    ----------
    source
        Name of the file, for messages.
    names
        Name of each column without its unit; ``column 0`` and so on when the file has none.
    units
        Unit of each column as it stands in the file; empty if not given.
    columns
        Read-only vectors, float64. Text and missing values are NaN. In a text file all have the
        same length; in a file of separate arrays they need not.
    headers
        Each column's header in full, for instance ``voltage [V]``.
    flaws
        The first entry of each column that is not a finite number, or None.
    lines
        For a text file, the 1-based line of each row.
    aliases
        Other rows of names in which a column may be looked up.
    doubts
        By column, what in the file contradicts its unit.
    step
        Seconds between rows where the file states them outside its columns.
    notes
        What was left out of the file, one sentence each.
    notes_of_columns
        By column, how its cells were read where that had to be found out.

    Examples
    --------
    >>> table = table_of("a.npz", {"u": np.array([1.0, np.nan])})
    >>> table.names, table.flaws[0].row, table.place(1)
    (('u',), 1, 'index 1')
    """

    source: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    columns: tuple[NDArray[np.float64], ...]
    headers: tuple[str, ...]
    flaws: tuple[Flaw | None, ...]
    lines: NDArray[np.intp] | None = None
    aliases: tuple[tuple[str, ...], ...] = ()
    doubts: Mapping[int, str] = field(default_factory=dict)
    step: float | None = None
    notes: tuple[str, ...] = ()
    notes_of_columns: Mapping[int, tuple[str, ...]] = field(default_factory=dict)

    def place(self, row: int) -> str:
        """Say where a row is: its line in a text file, its index elsewhere.

        Parameters
        ----------
        row
            Index of the row, from 0.
        """
        return f"index {row}" if self.lines is None else f"line {self.lines[row]}"


def table_of(
    source: str, columns: dict[str, NDArray[np.float64]], units: dict[str, str] | None = None
) -> Table:
    """Make a table of a binary file's columns, whose names are whole headers without a unit.

    Parameters
    ----------
    source
        Name of the file.
    columns
        Vectors by name, float64.
    units
        Units of those columns that have one.

    Returns
    -------
    Table
        The columns in the order given.
    """
    for vector in columns.values():
        vector.flags.writeable = False
    return Table(
        source=source,
        names=tuple(columns),
        units=tuple((units or {}).get(name, "") for name in columns),
        columns=tuple(columns.values()),
        headers=tuple(columns),
        flaws=tuple(first_flaw(vector) for vector in columns.values()),
    )


def first_flaw(vector: NDArray[np.float64]) -> Flaw | None:
    """Find the first entry that is not finite."""
    finite = np.isfinite(vector)
    if finite.all():
        return None
    row = int(np.argmin(finite))
    return Flaw(row, str(float(vector[row])))

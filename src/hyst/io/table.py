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
    left_out
        What else the file holds, and why it is no column: a phrase that follows the name.

    Examples
    --------
    >>> u = np.array([1.0, np.nan])
    >>> table = Table("a.npz", ("u",), ("V",), (u,), ("u [V]",), (first_flaw(u),))
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
    left_out: Mapping[str, str] = field(default_factory=dict)

    def place(self, row: int) -> str:
        """Say where a row is: its line in a text file, its index elsewhere.

        Parameters
        ----------
        row
            Index of the row, from 0.
        """
        return f"index {row}" if self.lines is None else f"line {self.lines[row]}"


def first_flaw(vector: NDArray[np.float64]) -> Flaw | None:
    """Find the first entry that is not finite."""
    finite = np.isfinite(vector)
    if finite.all():
        return None
    row = int(np.argmin(finite))
    return Flaw(row, str(float(vector[row])))

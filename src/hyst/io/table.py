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
    """

    row: int
    text: str


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

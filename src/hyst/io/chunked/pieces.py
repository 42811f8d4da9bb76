"""What files that are read in chunks are cut into, whatever their format."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hyst.io.table import Flaw, Table

Array = NDArray[np.float64]

# Rows that are read at a time, however few are wanted: a megabyte a column.
ROWS_OF_A_PIECE = 1 << 17


@dataclass(frozen=True, eq=False)
class Piece:
    """Some consecutive rows of a file.

    Parameters
    ----------
    start
        Index of the first of them in the file.
    values
        The columns that were asked for, NaN where there is no number.
    flaws
        The first entry of each that is no finite number, its row counted from ``start``.
    lines
        For a text file, the 1-based line of each row.
    """

    start: int
    values: tuple[Array, ...]
    flaws: tuple[Flaw | None, ...]
    lines: NDArray[np.intp] | None = None

    @property
    def size(self) -> int:
        """Number of rows."""
        return int(self.values[0].size)

    def rows(self) -> NDArray[np.intp]:
        """Give the places of its rows as ``placed`` counts them."""
        return np.arange(self.size) + (self.start if self.lines is None else 0)

    def placed(self, table: Table, columns: Sequence[int]) -> Table:
        """Give a table that says where rows of this piece are, and what is wrong in them.

        Parameters
        ----------
        table
            Of the file.
        columns
            Which columns the values are.
        """
        flaws = list(table.flaws)
        for column, flaw in zip(columns, self.flaws, strict=True):
            shift = self.start if self.lines is None else 0
            flaws[column] = None if flaw is None else replace(flaw, row=flaw.row + shift)
        return replace(table, flaws=tuple(flaws), lines=self.lines)


class Columns(Protocol):
    """The columns of a file that can be read piece by piece, again and again."""

    @property
    def table(self) -> Table:
        """Names, units and what else the file says; its columns have no values."""
        ...

    def pieces(self, columns: Sequence[int]) -> Iterator[Piece]:
        """Read some columns from the first row to the last."""
        ...


def regroup(
    pieces: Iterator[tuple[Array, ...]], samples: int, total: int
) -> Iterator[tuple[Array, ...]]:
    """Cut consecutive pieces anew, into ``samples`` rows each and a rest.

    Parameters
    ----------
    pieces
        Vectors of one length each.
    samples
        Wanted length, >= 1.
    total
        Rows of all pieces together.

    Examples
    --------
    >>> rows = iter([(np.array([1.0, 2.0]),), (np.array([3.0]),)])
    >>> [each[0].tolist() for each in regroup(rows, 1, 3)]
    [[1.0], [2.0], [3.0]]
    """
    given, filled = 0, 0
    out: tuple[Array, ...] = ()
    for piece in pieces:
        taken = 0
        while taken < piece[0].size:
            if not out:
                out = tuple(np.empty(min(samples, total - given)) for _ in piece)
            count = min(out[0].size - filled, piece[0].size - taken)
            for target, source in zip(out, piece, strict=True):
                target[filled : filled + count] = source[taken : taken + count]
            filled, taken = filled + count, taken + count
            if filled == out[0].size:
                yield out
                given, filled, out = given + filled, 0, ()

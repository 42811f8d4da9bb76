"""Parse rows of plain numbers at the speed of C: by the engine, or by NumPy where it cannot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst._engine import has_number_text, text_as_rows


@dataclass(frozen=True, eq=False)
class Body:
    """Rows of plain numbers: digits, signs, points, exponents and separators, and line feeds.

    Parameters
    ----------
    data
        Bytes with the rows in them.
    start, stop
        Where the rows begin, and one past their last digit; by default all.
    """

    data: bytes
    start: int = 0
    stop: int | None = None

    @property
    def size(self) -> int:
        """Number of bytes."""
        return (len(self.data) if self.stop is None else self.stop) - self.start

    def rows(self) -> int:
        """Count the lines."""
        return self.data.count(b"\n", self.start, self.start + self.size) + 1

    def lines(self) -> list[str]:
        """Give the lines as text."""
        return self.data[self.start : self.start + self.size].decode("ascii").split("\n")


def parse_numbers(
    body: Body, count: int, separator: str | None, used: Sequence[int]
) -> NDArray[np.float64] | None:
    r"""Parse rows of numbers with a decimal point.

    Parameters
    ----------
    body
        The rows.
    count
        Cells in each.
    separator
        One character, or None for white space.
    used
        Columns that are wanted.

    Returns
    -------
    numpy.ndarray or None
        Shape (count, rows), the doubles next to what is written, NaN in columns not wanted; None
        if a cell is no number or a line has more or fewer.

    Examples
    --------
    >>> parse_numbers(Body(b"0.5,-1.25\n10.5,0.75"), 2, ",", [1])
    array([[  nan,   nan],
           [-1.25,  0.75]])
    """
    rows = body.rows()
    values = np.full((count, rows), np.nan) if len(used) < count else np.empty((count, rows))
    if has_number_text():
        stop = body.start + body.size
        found = text_as_rows(body.data, body.start, stop, separator or "", list(used), values)
        return values if found else None
    columns = _by_numpy(body, count, separator, used)
    if columns is None or any(column.size != rows for column in columns):
        return None
    for k, column in zip(used, columns, strict=True):
        values[k] = column
    return values


def _by_numpy(
    body: Body, count: int, separator: str | None, used: Sequence[int]
) -> list[NDArray[np.float64]] | None:
    # Columns that are not used are parsed too: only so are lines of other lengths noticed.
    try:
        found = np.loadtxt(body.lines(), delimiter=separator, comments=None, ndmin=2)
    except ValueError:
        return None
    return [found[:, k] for k in used] if found.shape[1] == count else None

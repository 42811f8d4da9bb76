"""Parse rows of plain numbers at the speed of C: by pyarrow where it is there, else by NumPy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

# Loading pyarrow takes as long as NumPy needs for some megabytes.
_WORTH_LOADING = 1 << 22
_BLOCK = 1 << 20


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
    columns, rows = None, body.rows()
    if separator is not None and body.size >= _WORTH_LOADING:
        columns = _by_arrow(body, count, separator, used)
    if columns is None:
        columns = _by_numpy(body, count, separator, used)
    if columns is None or any(column.size != rows for column in columns):
        return None
    values = np.full((count, rows), np.nan) if len(used) < count else np.empty((count, rows))
    for k, column in zip(used, columns, strict=True):
        values[k] = column
    return values


def _by_arrow(
    body: Body, count: int, separator: str, used: Sequence[int]
) -> list[NDArray[np.float64]] | None:
    try:
        import pyarrow as arrow
        from pyarrow import csv
    except ImportError:
        return None
    names = [str(k) for k in range(count)]
    wanted = [names[k] for k in used]
    try:
        table: Any = csv.read_csv(
            arrow.BufferReader(arrow.py_buffer(body.data).slice(body.start, body.size)),
            csv.ReadOptions(column_names=names, use_threads=False, block_size=_BLOCK),
            csv.ParseOptions(delimiter=separator, quote_char=False, ignore_empty_lines=False),
            csv.ConvertOptions(
                column_types=dict.fromkeys(wanted, arrow.float64()),
                include_columns=wanted,
                null_values=[],
            ),
        )
    except (arrow.ArrowException, ValueError):
        return None
    return [table.column(name).to_numpy() for name in wanted]


def _by_numpy(
    body: Body, count: int, separator: str | None, used: Sequence[int]
) -> list[NDArray[np.float64]] | None:
    # Columns that are not used are parsed too: only so are lines of other lengths noticed.
    try:
        found = np.loadtxt(body.lines(), delimiter=separator, comments=None, ndmin=2)
    except ValueError:
        return None
    return [found[:, k] for k in used] if found.shape[1] == count else None

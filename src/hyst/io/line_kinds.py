"""Sort the lines of a text file by how many cells and how many numbers they have."""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.io.cells import is_missing, number_pattern
from hyst.io.notation import Writing

TEXT, MIXED, NUMERIC = 0, 1, 2


@dataclass(frozen=True, eq=False)
class LineKinds:
    """Number of cells and kind of each line.

    Parameters
    ----------
    counts
        Cells, shape (L,).
    kinds
        ``TEXT`` (no number at all), ``MIXED`` or ``NUMERIC``, shape (L,).
    """

    counts: NDArray[np.intp]
    kinds: NDArray[np.int8]

    def cut(self, start: int, stop: int) -> LineKinds:
        """Give those of some of the lines.

        Parameters
        ----------
        start, stop
            The first of them, and one past the last.
        """
        return LineKinds(self.counts[start:stop], self.kinds[start:stop])


def sort_lines(lines: Sequence[str], writing: Writing) -> LineKinds:
    """Sort lines; a line of nothing but signs for missing values is numeric.

    Parameters
    ----------
    lines
        Without comments and blank ones.
    writing
        How they are written.

    Returns
    -------
    LineKinds

    Examples
    --------
    >>> found = sort_lines(["u,y", "1,2", "3,x", "nan,nan"], Writing(",", "."))
    >>> found.counts.tolist(), found.kinds.tolist()
    ([2, 2, 2, 2], [0, 2, 1, 2])
    """
    counts = np.empty(len(lines), dtype=np.intp)
    kinds = np.empty(len(lines), dtype=np.int8)
    plain = _plain_line(writing).fullmatch
    separator = writing.separator
    for row, line in enumerate(lines):
        if plain(line):
            counts[row] = len(line.split()) if separator is None else line.count(separator) + 1
            kinds[row] = NUMERIC
        else:
            counts[row], kinds[row] = _sort(line, writing)
    return LineKinds(counts, kinds)


def _sort(line: str, writing: Writing) -> tuple[int, int]:
    cells = writing.cells(line)
    missing = [is_missing(cell) for cell in cells]
    if all(missing):
        return len(cells), NUMERIC if len(cells) > 1 or cells[0] else TEXT
    values = sum(
        not gone and writing.has_value(cell) for gone, cell in zip(missing, cells, strict=True)
    )
    if not values:
        return len(cells), TEXT
    return len(cells), NUMERIC if values + sum(missing) == len(cells) else MIXED


@functools.cache
def _plain_line(writing: Writing) -> re.Pattern[str]:
    """Give the pattern of a line of plain numbers alone."""
    number = number_pattern(writing.decimal).pattern
    between = (
        r"\s+" if writing.separator is None else rf"[ \t]*{re.escape(writing.separator)}[ \t]*"
    )
    return re.compile(rf"\s*{number}(?:{between}{number})*\s*", re.ASCII)

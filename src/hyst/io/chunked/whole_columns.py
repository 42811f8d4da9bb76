"""The columns of a text file so small that it is read as a whole each time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hyst.io.chunked.pieces import Piece
from hyst.io.formats import read_table
from hyst.io.table import Table


@dataclass(frozen=True, eq=False)
class WholeColumns:
    """Columns of a small text file, however it is written.

    Parameters
    ----------
    path
        The file.
    table
        As of ``Columns``.
    """

    path: Path
    table: Table

    @classmethod
    def open(cls, path: Path) -> WholeColumns:
        """Find the columns of a file.

        Raises
        ------
        InputError
            As ``read_table``.
        """
        table = read_table(path, format="text")
        none = np.empty(0)
        return cls(path, replace(table, columns=(none,) * len(table.columns), lines=None))

    def pieces(self, columns: Sequence[int]) -> Iterator[Piece]:
        """Read some columns from the first row to the last."""
        table = read_table(self.path, format="text")
        values = tuple(table.columns[k] for k in columns)
        yield Piece(0, values, tuple(table.flaws[k] for k in columns), table.lines)

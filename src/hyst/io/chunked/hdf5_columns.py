"""The data sets of an HDF5 file, piece by piece."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from hyst.errors import InputError
from hyst.io.chunked.pieces import ROWS_OF_A_PIECE, Piece
from hyst.io.entries import Wanted, table_of_entries, vector_of_entry
from hyst.io.hdf5 import opened_entries
from hyst.io.table import Table


@dataclass(frozen=True, eq=False)
class Hdf5Columns:
    """Columns of an HDF5 file, or of a MATLAB file of version 7.3.

    Parameters
    ----------
    path
        The file.
    separator
        What stands between the groups of a name.
    table
        As of ``Columns``.
    sizes
        Number of values of each column.
    """

    path: Path
    separator: str
    table: Table
    sizes: tuple[int, ...]

    @classmethod
    def open(cls, path: Path, separator: str) -> Hdf5Columns:
        """Find the columns of a file.

        Parameters
        ----------
        path, separator
            As of ``read_hdf5``.

        Raises
        ------
        InputError, MissingExtraError
            As ``read_hdf5``.
        """
        with opened_entries(path, separator) as (entries, left_out):
            table = table_of_entries(str(path), entries, Wanted(columns=()), left_out)
            return cls(path, separator, table, tuple(entry.size for entry in entries))

    def pieces(self, columns: Sequence[int]) -> Iterator[Piece]:
        """Read some columns from the first row to the last.

        Raises
        ------
        InputError
            If their lengths differ, or the file is damaged.
        """
        sizes = [self.sizes[k] for k in columns]
        if len(set(sizes)) > 1:
            names = [self.table.names[k] for k in columns]
            pairs = " and ".join(f"{name!r} {n}" for name, n in zip(names, sizes, strict=True))
            raise InputError(
                f"{self.table.source}: the columns have different numbers of values, {pairs}; "
                "choose columns of one length"
            )
        with opened_entries(self.path, self.separator) as (entries, _):
            chosen = [entries[k] for k in columns]
            for start in range(0, sizes[0], ROWS_OF_A_PIECE):
                stop = min(start + ROWS_OF_A_PIECE, sizes[0])
                read = [
                    vector_of_entry(partial(entry.part, start, stop), entry.gap)
                    for entry in chosen
                    if entry.part is not None
                ]
                yield Piece(start, tuple(v for v, _ in read), tuple(flaw for _, flaw in read))

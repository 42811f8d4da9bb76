"""The columns of a Parquet file, piece by piece."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hyst.errors import InputError
from hyst.io.chunked.pieces import ROWS_OF_A_PIECE, Piece
from hyst.io.entries import Wanted
from hyst.io.parquet import is_clock, read_parquet, vector_of
from hyst.io.table import Table, first_flaw

# Pages are unpacked as they are asked for, from so many bytes at a time.
_BUFFER = 1 << 20


@dataclass(frozen=True, eq=False)
class ParquetColumns:
    """Columns of a Parquet file.

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
    def open(cls, path: Path) -> ParquetColumns:
        """Find the columns of a file.

        Raises
        ------
        InputError, MissingExtraError
            As ``read_parquet``, and if two columns have one name.
        """
        table = read_parquet(path, Wanted(columns=()))
        for k, header in enumerate(table.headers):
            if header in table.headers[:k]:
                raise InputError(
                    f"{path} has two columns {header!r}, which cannot be read in chunks; give "
                    "each a name of its own"
                )
        return cls(path, table)

    def pieces(self, columns: Sequence[int]) -> Iterator[Piece]:
        """Read some columns from the first row to the last."""
        import pyarrow as arrow
        from pyarrow import compute, parquet

        wanted = [self.table.headers[k] for k in columns]
        earliest: dict[str, Any] = {}
        start = 0
        with parquet.ParquetFile(self.path, buffer_size=_BUFFER, pre_buffer=False) as file:
            batches = file.iter_batches(
                batch_size=ROWS_OF_A_PIECE, columns=wanted, use_threads=False
            )
            while (batch := self._next(batches)) is not None:
                for name in wanted:
                    column = batch.column(name)
                    if is_clock(column.type, arrow.types) and name not in earliest:
                        earliest[name] = column[0].cast(arrow.int64()).as_py() or 0
                values = tuple(
                    vector_of(column, column.type, arrow, compute, earliest.get(name))
                    for name in wanted
                    for column in [arrow.chunked_array([batch.column(name)])]
                )
                yield Piece(start, values, tuple(map(first_flaw, values)))
                start += batch.num_rows

    def _next(self, batches: Iterator[Any]) -> Any:
        """Read the next rows; a damaged file fails anywhere in the library, with any exception."""
        try:
            return next((each for each in batches if each.num_rows), None)
        except Exception as error:
            raise InputError(
                f"{self.path} is damaged or no Parquet file ({type(error).__name__}); save it again"
            ) from error

"""The columns of a large text file, piece by piece: plain rows below a head of the usual kind."""

from __future__ import annotations

import codecs
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hyst.errors import InputError
from hyst.io.cell_values import read_cells
from hyst.io.chunked.pieces import Array, Piece
from hyst.io.columns import refuse_flaws
from hyst.io.fast_numbers import parse_numbers
from hyst.io.notation import Writing
from hyst.io.plain_text import head_of, plain_body, start_of_line, titled
from hyst.io.table import Flaw, Table
from hyst.io.text import read_text
from hyst.io.text_lines import is_comment

_HEAD = 1 << 16
# Bytes that are read at a time.
_BYTES = 1 << 22
_WHOLE = "read it as a whole with read_record"


@dataclass(frozen=True, eq=False)
class TextColumns:
    """Columns of a large text file.

    Parameters
    ----------
    path
        The file.
    table
        As of ``Columns``.
    writing
        How the rows are written.
    first_byte, first_line
        Where the first row begins, from 0, and its line, from 1.
    """

    path: Path
    table: Table
    writing: Writing
    first_byte: int
    first_line: int

    @classmethod
    def open(cls, path: Path) -> TextColumns:
        """Find out how a file is written.

        Raises
        ------
        InputError
            If its rows do not follow each other below one head, or the head is unusual.
        """
        with path.open("rb") as file:
            data = file.read(_HEAD)
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            raise InputError(
                f"{path} is written in UTF-16, which cannot be read in chunks; save it as UTF-8, "
                f"or {_WHOLE}"
            )
        data = data[: data.rfind(b"\n") + 1]
        found = head_of(data, str(path))
        if found is None:
            raise _unusual(path, data)
        page, block = found
        line = page.lines.numbers[block.first]
        start = start_of_line(data, line)
        rows = [page.writing.cells(page.lines.texts[k]) for k in range(block.first, block.stop)]
        read = [read_cells(cells, page.writing.decimal) for cells in zip(*rows, strict=True)]
        values = np.array([column.values for column in read])
        table = titled(page, block, values, line)
        if any(column.unit or column.notes or column.flaw for column in read) or any(
            kept is not given and not np.array_equal(kept, given)
            for kept, given in zip(table.columns, values, strict=True)
        ):
            raise _unusual(path, data)
        return cls(
            path, titled(page, block, np.empty((block.count, 0)), line), page.writing, start, line
        )

    def pieces(self, columns: Sequence[int]) -> Iterator[Piece]:
        """Read some columns from the first row to the last."""
        start, line = 0, self.first_line
        with self.path.open("rb") as file:
            file.seek(self.first_byte)
            rest = b""
            while more := file.read(_BYTES):
                block, end, rest = (rest + more).rpartition(b"\n")
                if not end:
                    continue
                for piece in self._read(block + end, start, line, columns):
                    yield piece
                    start += piece.size
                line += block.count(b"\n") + 1
            if rest.strip():
                yield from self._read(rest, start, line, columns)

    def _read(self, data: bytes, start: int, line: int, columns: Sequence[int]) -> Iterator[Piece]:
        """Read whole lines; nothing comes of blank ones."""
        body = plain_body(data, 0, self.writing)
        count, used = len(self.table.names), sorted(set(columns))
        values = None
        if body is not None and body.size:
            values = parse_numbers(body, count, self.writing.separator, used)
        if values is not None and np.isfinite(values[used]).all():
            lines = np.arange(line, line + values.shape[1], dtype=np.intp)
            yield Piece(start, tuple(values[k] for k in columns), (None,) * len(columns), lines)
            return
        cells, numbers = self._cells(data, line)
        if not cells:
            return
        by_column = list(zip(*cells, strict=True))
        read = [self._values(by_column[k], numbers, k) for k in columns]
        lines = np.array(numbers, dtype=np.intp)
        yield Piece(start, tuple(v for v, _ in read), tuple(flaw for _, flaw in read), lines)

    def _cells(self, data: bytes, line: int) -> tuple[list[list[str]], list[int]]:
        """Cut lines that are neither blank nor comments into cells, as many in each."""
        found: list[list[str]] = []
        numbers: list[int] = []
        count = len(self.table.names)
        for number, text in enumerate(data.decode("latin-1").split("\n"), line):
            if not text.strip() or is_comment(text):
                continue
            cells = self.writing.cells(text)
            if len(cells) != count:
                raise InputError(
                    f"{self.path}: line {number} has {len(cells)} values and line "
                    f"{self.first_line} has {count}; every line needs as many"
                )
            found.append(cells)
            numbers.append(number)
        return found, numbers

    def _values(
        self, cells: Sequence[str], numbers: Sequence[int], column: int
    ) -> tuple[Array, Flaw | None]:
        """Read cells of a column whose first rows were plain numbers."""
        read = read_cells(cells, self.writing.decimal)
        if read.unit or read.notes:
            raise InputError(
                f"{self.path}: {self.table.names[column]!r} is written otherwise from line "
                f"{numbers[0]} on than above; {_WHOLE}"
            )
        return read.values, read.flaw


def _unusual(path: Path, data: bytes) -> InputError:
    """Say why a head cannot be read: as the reader of whole files does where it can."""
    for table in read_text(data, str(path)):
        for k in range(len(table.names)):
            refuse_flaws(table, k, f"correct it, or {_WHOLE} and repair")
    return InputError(
        f"{path} is not written as plain rows of numbers below one header, so it cannot be read "
        f"in chunks; {_WHOLE}, or save its signals as Parquet"
    )

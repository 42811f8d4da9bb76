"""Read the columns of an Excel workbook."""

from __future__ import annotations

import datetime
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hyst.errors import HystError, InputError, MissingExtraError
from hyst.io.entries import Wanted, refuse_too_many
from hyst.io.table import Table
from hyst.io.text import read_text

SUFFIXES = (".xlsx", ".xlsm")
# A number takes some 20 bytes of the sheet's XML, and rarely more than this.
_BYTES_PER_NUMBER = 64
_WIDEST = 1000


def read_xlsx(path: Path, wanted: Wanted) -> Table:
    """Read the sheets of a workbook that hold columns of numbers.

    A sheet is read as a text file of the same rows would be: preamble, header and units are found
    out. Of formulas the values that were saved with them are taken.

    Parameters
    ----------
    path
        The file.
    wanted
        How many numbers to read at most; all columns are read.

    Returns
    -------
    Table
        The columns of the sheet, its rows counted as lines. If several sheets hold numbers, all
        their columns, with headers such as ``Sheet1!voltage [V]``.

    Raises
    ------
    InputError
        If the file is damaged or no workbook, holds no column, or more than is allowed.
    MissingExtraError
        If openpyxl is not installed.
    """
    try:
        import openpyxl
    except ImportError as error:
        raise MissingExtraError(
            f'{path}: Excel workbooks need openpyxl; pip install "hyst[files]"'
        ) from error
    try:
        with zipfile.ZipFile(path) as archive:
            declared = sum(member.file_size for member in archive.infolist())
        refuse_too_many(str(path), declared / _BYTES_PER_NUMBER, wanted.most)
        workbook = openpyxl.load_workbook(path, read_only=True, data_only=True)
        try:
            sheets = {sheet.title: _rows(sheet) for sheet in workbook.worksheets}
        finally:
            workbook.close()
    except HystError:
        raise
    # A damaged file fails in zipfile, the XML parser or the library, with any exception.
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no Excel workbook ({type(error).__name__}); save it again"
        ) from error
    return _joined(path, {title: rows for title, rows in sheets.items() if _has_numbers(rows)})


def _rows(sheet: Any) -> list[list[str]]:
    """Give the cells of a sheet as texts, without the empty columns and rows around them."""
    sheet.reset_dimensions()  # what a file says of its size need not be true
    rows = [[_text(cell) for cell in row[:_WIDEST]] for row in sheet.iter_rows(values_only=True)]
    while rows and not any(rows[-1]):
        rows.pop()
    used = [k for row in rows for k, cell in enumerate(row) if cell]
    if not used:
        return []
    first, last = min(used), max(used) + 1
    return [(row + [""] * last)[first:last] for row in rows]


def _text(cell: object) -> str:
    if cell is None:
        return ""
    if isinstance(cell, bool):
        return str(int(cell))
    if isinstance(cell, datetime.datetime | datetime.date | datetime.time):
        return cell.isoformat()
    if isinstance(cell, datetime.timedelta):
        return repr(cell.total_seconds())
    return " ".join(str(cell).split())


def _has_numbers(rows: list[list[str]]) -> bool:
    """Tell a table of numbers from notes: at least two rows with a number."""
    return sum(any(_is_number(cell) for cell in row) for row in rows) >= 2


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _joined(path: Path, sheets: dict[str, list[list[str]]]) -> Table:
    if not sheets:
        raise InputError(
            f"{path} has no sheet with columns of numbers; formulas count only if the workbook was "
            "saved by a program that works them out"
        )
    tables = {title: _table(path, title, rows, len(sheets)) for title, rows in sheets.items()}
    if len(tables) == 1:
        return next(iter(tables.values()))
    return Table(
        source=str(path),
        names=tuple(name for table in tables.values() for name in table.names),
        units=tuple(unit for table in tables.values() for unit in table.units),
        columns=tuple(column for table in tables.values() for column in table.columns),
        headers=tuple(
            f"{title}!{header}" for title, table in tables.items() for header in table.headers
        ),
        flaws=tuple(flaw for table in tables.values() for flaw in table.flaws),
    )


def _table(path: Path, title: str, rows: list[list[str]], sheets: int) -> Table:
    """Read a sheet by way of text, so that headers and units are found alike in both."""
    source = str(path) if sheets == 1 else f"{path}, sheet {title!r}"
    found = read_text("".join(_lines(rows)).encode(), source)
    if len(found) > 1:
        raise InputError(
            f"{source} holds {len(found)} tables below each other; put each into a sheet of its own"
        )
    return found[0]


def _lines(rows: Sequence[list[str]]) -> Iterator[str]:
    """Write a line a row; quotes would join lines, and tabs end cells."""
    for row in rows:
        yield "\t".join(cell.replace('"', "") for cell in row) + "\n"

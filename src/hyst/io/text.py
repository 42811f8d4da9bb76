"""Read columns of numbers from a text file."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.decoding import decode
from hyst.io.header import split_unit
from hyst.io.table import Flaw, Table
from hyst.io.text_layout import (
    Writing,
    drop_trailing_separators,
    find_first_row,
    find_titles,
    find_writing,
    refuse_doubtful_row,
)

SUFFIXES = (".csv", ".tsv", ".txt", ".dat", ".asc", ".tab", ".prn")
# The last is how a spreadsheet is told the separator.
_COMMENTS = ("#", "%", "//", "sep=")
# What spreadsheets write for a value they could not compute: a fault in a row, not a comment.
_SPREADSHEET_ERRORS = ("#N/A", "#DIV/0!", "#VALUE!", "#REF!", "#NAME?", "#NUM!", "#NULL!")


def read_text(path: Path) -> Table:
    """Read a text file of columns.

    Cells are separated by tabs, semicolons, commas or white space, numbers have a decimal point
    or comma; both are found out from the file. Blank lines and lines that start with ``#``,
    ``%`` or ``//`` are skipped. Headers are optional and may stand in the last comment line.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Table
        One column a column; what is no number is NaN.

    Raises
    ------
    InputError
        If the file is not text, holds no numbers, or its lines have different numbers of cells.
    """
    source = str(path)
    numbers, lines, comment = _significant_lines(decode(path.read_bytes(), source))
    if not lines:
        raise InputError(f"{source} holds no line of numbers; give a file with columns of numbers")
    writing = find_writing(lines)
    lines = drop_trailing_separators(lines, writing)
    first = find_first_row(lines, writing, source)
    above, body, body_lines = lines[:first], lines[first:], np.array(numbers[first:], dtype=np.intp)
    values = _parse_regular(body, writing)
    if values is None:
        values = _parse_irregular(body, writing, body_lines, source)
    count = values.shape[0]
    titles = find_titles(above, comment, count, writing)
    if titles is None:
        if above:
            _refuse_odd_header(above[-1], count, writing, numbers[first - 1], source)
        refuse_doubtful_row(body, writing, f"{source}: line {body_lines[0]}")
    headers = titles or [f"column {k}" for k in range(count)]
    named = [split_unit(header) for header in titles] if titles else [(h, "") for h in headers]
    values.flags.writeable = False
    return Table(
        source=source,
        names=tuple(name for name, _ in named),
        units=tuple(unit for _, unit in named),
        columns=tuple(values),
        headers=tuple(headers),
        flaws=tuple(_first_flaw(values, k, body, writing) for k in range(count)),
        lines=body_lines,
    )


def _significant_lines(text: str) -> tuple[list[int], list[str], str]:
    """Lines that are neither blank nor comments, their numbers, and the comment before them."""
    numbers: list[int] = []
    lines: list[str] = []
    comment = ""
    for number, line in enumerate(text.split("\n"), 1):
        start = line.lstrip()
        if start.startswith(_COMMENTS) and not start.startswith(_SPREADSHEET_ERRORS):
            comment = comment if lines else start.lstrip("#%/").strip()
        elif start:
            numbers.append(number)
            lines.append(line)
    return numbers, lines, comment


def _parse_regular(body: list[str], writing: Writing) -> NDArray[np.float64] | None:
    """Parse at the speed of C when every cell is a number; None when one is not."""
    if writing.decimal == ",":
        if any("." in line for line in body):
            return None
        body = [line.replace(",", ".") for line in body]
    try:
        values = np.loadtxt(body, delimiter=writing.separator, comments=None, ndmin=2)
    except ValueError:
        return None
    return np.ascontiguousarray(values.T) if values.shape[0] == len(body) else None


def _parse_irregular(
    body: list[str], writing: Writing, lines: NDArray[np.intp], source: str
) -> NDArray[np.float64]:
    """Parse cell by cell; what is no number becomes NaN."""
    rows = [writing.cells(line) for line in body]
    count = len(rows[0])
    for row, cells in enumerate(rows):
        if len(cells) != count:
            raise InputError(
                f"{source}: line {lines[row]} has {len(cells)} values and line {lines[0]} has "
                f"{count}; every line needs as many"
            )
    values = np.empty((count, len(rows)))
    for column in range(count):
        values[column] = [_number(cells[column], writing) for cells in rows]
    return values


def _number(cell: str, writing: Writing) -> float:
    if writing.decimal == ",":
        if "." in cell:
            return math.nan
        cell = cell.replace(",", ".")
    # float() also takes 1_000 and digits of other scripts, which no instrument writes.
    if "_" in cell or not cell.isascii():
        return math.nan
    try:
        return float(cell)
    except ValueError:
        return math.nan


def _first_flaw(
    values: NDArray[np.float64], column: int, body: list[str], writing: Writing
) -> Flaw | None:
    finite = np.isfinite(values[column])
    if finite.all():
        return None
    row = int(np.argmin(finite))
    return Flaw(row, writing.cells(body[row])[column])


def _refuse_odd_header(line: str, count: int, writing: Writing, number: int, source: str) -> None:
    named = len(writing.cells(line))
    if writing.separator is not None and named > 1:
        raise InputError(
            f"{source}: line {number} names {named} columns, but the lines below it have {count} "
            "values; correct it or make it a comment with #"
        )

"""Read large plain tables at the speed of C: numbers alone below a head of the usual kind."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.cell_values import ColumnOfCells
from hyst.io.columns import find_column
from hyst.io.decoding import decode
from hyst.io.fast_numbers import Body, parse_numbers
from hyst.io.line_kinds import NUMERIC, sort_lines
from hyst.io.lvm import is_lvm
from hyst.io.notation import Writing, find_writing
from hyst.io.table import Table
from hyst.io.text_block import Page, with_titles
from hyst.io.text_lines import significant_lines
from hyst.io.text_tables import Block, find_blocks

_LARGE = 1 << 16
_HEAD = 1 << 14
_DIGITS = b"0123456789+-eE \r\n"


def read_plain(
    data: bytes, source: str, columns: Sequence[int | str] | None = None, large: int = _LARGE
) -> Table | None:
    """Read a table of plain numbers below a head of the usual kind.

    Parameters
    ----------
    data
        Content of the file.
    source
        Name of the file, for messages.
    columns
        Columns to read, as ``find_column`` takes them; by default all. Others have no values.
    large
        Fewest bytes for which this is worth while.

    Returns
    -------
    Table or None
        What ``read_text`` gives; None where the file is small or anything in it is unusual.

    Raises
    ------
    InputError
        If there is no such column.
    """
    if len(data) < large:
        return None
    found = head_of(data[: data.rfind(b"\n", 0, _HEAD) + 1], source)
    if found is None:
        return None
    page, block = found
    number = page.lines.numbers[block.first]
    start = start_of_line(data, number)
    body = plain_body(data, start, page.writing)
    if body is None:
        return None
    preview = titled(page, block, np.zeros((block.count, 2)), number)
    used = list(range(block.count))
    if columns is not None:
        used = sorted({find_column(preview, column) for column in columns})
    values = parse_numbers(body, block.count, page.writing.separator, used)
    if values is None or not np.isfinite(values[used]).all():
        return None
    table = titled(page, block, values, number)
    if len(used) == block.count:
        return table
    none = np.empty(0)
    kept = [each if k in used else none for k, each in enumerate(table.columns)]
    return replace(table, columns=tuple(kept))


def head_of(data: bytes, source: str) -> tuple[Page, Block] | None:
    """Find out how the file is written; None unless all lines after the head are plain rows.

    Parameters
    ----------
    data
        Its beginning, whole lines.
    source
        Its name.
    """
    try:
        text = decode(data, source)
        lines = significant_lines(text)
        if is_lvm(text) or not lines.texts:
            return None
        writing = find_writing(lines.texts)
        kinds = sort_lines(lines.texts, writing)
        blocks = find_blocks(lines.texts, kinds, lines.after_gap, writing, lines.comments)
    except InputError:
        return None  # the reader of all texts says it better
    if len(blocks) != 1 or blocks[0].faulty or blocks[0].loose:
        return None
    block = blocks[0]
    numbers = lines.numbers[block.first :]
    if not (kinds.kinds[block.first :] == NUMERIC).all() or block.stop - block.first < 2:
        return None
    if any(after != before + 1 for before, after in itertools.pairwise(numbers)):
        return None
    return Page(source, lines, kinds, writing), block


def plain_body(data: bytes, start: int, writing: Writing) -> Body | None:
    """Give rows with a decimal point and plain line ends; None if there is more than numbers.

    Parameters
    ----------
    data
        Bytes with the rows in them.
    start
        Where they begin.
    writing
        How they are written.
    """
    decimal, separator = writing.decimal.encode(), (writing.separator or "\t").encode()
    if decimal == separator:
        return None
    stop = len(data)
    while stop > start and data[stop - 1] in b"\r\n ":
        stop -= 1
    allowed = _DIGITS + decimal + separator
    # Copies of so many bytes would take as long as reading the numbers.
    if len(data.translate(None, allowed)) > len(data[:start].translate(None, allowed)):
        return None
    if decimal == b"." and data.find(b"\r", start) < 0:
        return Body(data, start, stop)
    body = data[start:stop].replace(b"\r\n", b"\n")
    if b"\r" in body:
        return None
    return Body(body if decimal == b"." else body.replace(b",", b"."))


def start_of_line(data: bytes, number: int) -> int:
    """Give the byte at which a line begins.

    Parameters
    ----------
    data
        Content of the file.
    number
        The line, from 1.
    """
    start = 0
    for _ in range(number - 1):
        start = data.index(b"\n", start) + 1
    return start


def titled(page: Page, block: Block, values: NDArray[np.float64], number: int) -> Table:
    """Join the numbers of a block, shape (columns, rows), and what stands above them.

    Parameters
    ----------
    page, block
        Where they stand.
    values
        The numbers.
    number
        Line of the first row.
    """
    columns = [ColumnOfCells(column, None) for column in values]
    numbers = np.arange(number, number + values.shape[1], dtype=np.intp)
    table = with_titles(page, block, columns, numbers)
    for column in table.columns:
        column.flags.writeable = False
    return table

"""What the first lines of a growing text file say: how it is written and which cells are wanted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from hyst.errors import InputError
from hyst.io.cell_values import ColumnOfCells
from hyst.io.cells import STAMP, is_missing, kind_of, number_pattern
from hyst.io.columns import refuse_doubts
from hyst.io.header import split_unit
from hyst.io.line_kinds import sort_lines
from hyst.io.notation import Writing, find_writing
from hyst.io.record_of_table import choose_columns
from hyst.io.stamps import seconds_of_stamps
from hyst.io.table import Table
from hyst.io.text_block import Page, with_titles
from hyst.io.text_lines import significant_lines
from hyst.io.text_tables import Block, find_blocks
from hyst.io.trailing_separators import drop_trailing_separators
from hyst.io.unit_of_stamps import unit_of_stamps

Roles = Mapping[str, int | str | None]


@dataclass(frozen=True, eq=False)
class Head:
    """How the rows of a growing file are written.

    Parameters
    ----------
    writing
        Separator and decimal sign.
    count
        Cells in a row.
    columns
        Places of input, output and, where there is one, time.
    names, units
        Of all columns.
    seconds
        In the unit of the time column.
    clock
        Place of the time of day that belongs to the date in the time column, or None.
    are_stamps
        Whether times are written as people read them.
    above
        Lines of text above the rows, which are no rows where they stand again.
    first_line
        Line of the first row, from 1.
    trailing
        Whether every row ends with a separator that separates nothing.
    notes
        What was found out about the columns.
    """

    writing: Writing
    count: int
    columns: tuple[int, ...]
    names: tuple[str, ...]
    units: tuple[str, ...]
    seconds: float
    clock: int | None
    are_stamps: bool
    above: frozenset[str]
    first_line: int
    trailing: bool
    notes: tuple[str, ...]

    def names_the_columns(self, line: str) -> bool:
        """Tell whether a line names the columns that are wanted, in whatever order."""
        titles = {
            split_unit(each.strip())[0].casefold() for each in self.writing.titles(line) if each
        }
        return all(self.names[k].casefold() in titles for k in self.columns)


def find_head(
    text: str,
    source: str,
    roles: Roles,
    time_unit: str | None,
    rows: int,
    before: Head | None = None,
) -> Head | None:
    r"""Read the first lines of a file.

    Parameters
    ----------
    text
        Whole lines, ended by a line feed.
    source
        Name of the file, for messages.
    roles
        The columns of ``input``, ``output`` and ``time``, as ``find_column`` takes them.
    time_unit
        Unit of the time; what the file says if None.
    rows
        Fewest rows by which the writing is judged.
    before
        Head of the file that stood there before; it holds where rows of as many cells have none.

    Returns
    -------
    Head or None
        None where there are not as many rows yet.

    Raises
    ------
    InputError
        If a column is missing, given twice or of an unknown unit of time.

    Examples
    --------
    >>> roles = {"input": "u", "output": "y", "time": None}
    >>> head = find_head("u [V];y\n1,5;2\n2,5;3\n", "a.csv", roles, None, 2)
    >>> head.columns, head.units, head.first_line
    ((0, 1), ('V', ''), 2)
    """
    lines = significant_lines(text)
    if not lines.texts:
        return None
    writing = find_writing(lines.texts)
    texts = drop_trailing_separators(lines.texts, writing)
    kinds = sort_lines(texts, writing)
    blocks = find_blocks(texts, kinds, lines.after_gap, writing, lines.comments)
    if not blocks or blocks[-1].stop - blocks[-1].first < rows:
        return None
    page, block = Page(source, replace(lines, texts=texts), kinds, writing), blocks[-1]
    body = [writing.cells(texts[k]) for k in range(block.first, block.stop)]
    regular = [cells for cells in body if len(cells) == block.count]
    table = _table(page, block, regular)
    try:
        columns = choose_columns(table, roles)
    except InputError:
        is_bare = block.first == block.above and not lines.comments
        if before is None or not is_bare or before.count != block.count:
            raise
        return replace(before, first_line=lines.numbers[block.first])
    for k in columns[:2]:
        refuse_doubts(table, k)
    seconds, told = 1.0, table.notes
    are_stamps = len(columns) > 2 and _are_stamps(regular, columns[2])
    if len(columns) > 2 and not are_stamps:
        seconds, more = unit_of_stamps(table, columns[2], table.columns[columns[2]], time_unit)
        told = (*told, *more)
    above = [lines.texts[k].strip() for k in range(block.above, block.first)]
    return Head(
        writing=writing,
        count=block.count,
        columns=tuple(columns),
        names=table.names,
        units=table.units,
        seconds=seconds,
        clock=_clock_beside(regular, columns[2]) if are_stamps else None,
        are_stamps=are_stamps,
        above=frozenset([*above, *lines.comments]),
        first_line=lines.numbers[block.first],
        trailing=texts[block.first] != lines.texts[block.first],
        notes=told,
    )


def _table(page: Page, block: Block, body: list[list[str]]) -> Table:
    """Give names, units and the values of plain cells; it needs no more to choose columns."""
    columns = []
    for cells in zip(*body, strict=True):
        kind = kind_of(cells[0], page.writing.decimal)
        if kind == "stamp":
            stamps = seconds_of_stamps(cells)
            columns.append(ColumnOfCells(stamps.seconds, None, "s", "", (), True))
        else:
            columns.append(_plain_column(cells, page.writing))
    numbers = np.arange(len(body), dtype=np.intp)
    return with_titles(page, block, columns, numbers)


def _plain_column(cells: tuple[str, ...], writing: Writing) -> ColumnOfCells:
    numbers = [number_of(cell, writing.decimal) for cell in cells]
    values = np.array([np.nan if each is None else each for each in numbers])
    return ColumnOfCells(values, None)


def number_of(cell: str, decimal: str) -> float | None:
    """Read a plain number; NaN where there is none, None where there is something else.

    Parameters
    ----------
    cell
        As it stands in the file.
    decimal
        The decimal sign.

    Examples
    --------
    >>> number_of("1,5", ","), number_of("n/a", "."), number_of("1.2.3", ".")
    (1.5, nan, None)
    """
    if number_pattern(decimal).fullmatch(cell):
        plain = cell.replace(",", ".") if decimal == "," else cell
        value = float(plain.replace("d", "e").replace("D", "e"))
        return value if np.isfinite(value) else np.nan
    return np.nan if is_missing(cell) else None


def _are_stamps(body: list[list[str]], column: int) -> bool:
    written = [cells[column] for cells in body if cells[column]]
    return bool(written) and all(STAMP.fullmatch(each) for each in written)


def _clock_beside(body: list[list[str]], column: int) -> int | None:
    """Find the column of times of day beside one of dates alone."""
    if any(":" in cells[column] for cells in body):
        return None
    for beside in (column + 1, column - 1):
        if 0 <= beside < len(body[0]) and all(":" in cells[beside] for cells in body):
            return beside
    return None

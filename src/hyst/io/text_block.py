"""Make a table of the lines of one in a text file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.cell_values import ColumnOfCells, read_cells
from hyst.io.cells import is_missing, kind_of
from hyst.io.dates_and_clocks import with_clocks
from hyst.io.header import is_time, unit_of_time_in_name
from hyst.io.line_kinds import NUMERIC, TEXT, LineKinds
from hyst.io.notation import Writing
from hyst.io.stated_step import start_and_step, stated_step, stated_unit_of_time
from hyst.io.table import Table
from hyst.io.text_lines import Lines
from hyst.io.text_tables import ENOUGH_ROWS, Block
from hyst.io.titles import Titles, find_titles

_LIKE_NUMBER = re.compile(r"[-+.,\deEdD]*\d[-+.,\deEdD]*", re.ASCII)


@dataclass(frozen=True, eq=False)
class Page:
    """The lines of a text file.

    Parameters
    ----------
    source
        Name of the file, for messages.
    lines
        Without comments and blank ones.
    kinds
        Of what kind each is.
    writing
        How they are written.
    """

    source: str
    lines: Lines
    kinds: LineKinds
    writing: Writing

    def unequal(self, row: int, other: int) -> InputError:
        """Give the refusal of a line that has another number of cells than another.

        Parameters
        ----------
        row, other
            Indices of the two lines.
        """
        numbers, counts = self.lines.numbers, self.kinds.counts
        return InputError(
            f"{self.source}: line {numbers[row]} has {counts[row]} values and line "
            f"{numbers[other]} has {counts[other]}; every line needs as many"
        )


def table_of_block(page: Page, block: Block, repair: bool, step: float | None) -> Table:
    """Read the columns of a block and what stands above them.

    Parameters
    ----------
    page, block
        Where the table stands.
    repair
        Make lines with another number of cells rows without values, instead of refusing them.
    step
        Seconds between rows, if known.

    Returns
    -------
    Table

    Raises
    ------
    InputError
        If lines have different numbers of cells, or header and rows do not fit.
    """
    odd = [k for k in block.faulty if page.kinds.counts[k] != block.count]
    if odd and not repair:
        raise page.unequal(odd[0], block.first)
    numbers = [page.lines.numbers[k] for k in range(block.first, block.stop)]
    columns = _columns(page, block, frozenset(odd))
    return with_titles(page, block, columns, np.array(numbers, dtype=np.intp), step)


def with_titles(
    page: Page,
    block: Block,
    columns: Sequence[ColumnOfCells],
    numbers: NDArray[np.intp],
    step: float | None = None,
) -> Table:
    """Join the columns of a block and what stands above them.

    Parameters
    ----------
    page, block
        Where the table stands.
    columns
        What its rows hold.
    numbers
        The line of each row.
    step
        Seconds between rows, if known.

    Returns
    -------
    Table

    Raises
    ------
    InputError
        If header and rows do not fit.
    """
    notes = _left_out(page, block)
    lines, writing = page.lines, page.writing
    # Half a line of numbers right above the rows must not hide the header above it.
    above = [lines.texts[k] for k in range(block.above, block.first) if not _is_part(page, k)]
    comments = lines.comments if block.above == 0 else ()
    axis = start_and_step(above, writing)
    titles = find_titles(_cut(above, axis, writing), comments, block.count, writing)
    if titles is None:
        _refuse_odd_header(page, block)
        _refuse_header_among_rows(page, block)
        _refuse_doubtful_row(page, block)
        titles = _numbered(columns)
    table = _joined(page.source, titles, columns, numbers)
    stated = step or (axis[2] if axis else stated_step([*comments, *above], writing))
    table = replace(table, notes=(*notes, *table.notes), step=stated)
    table = _with_unit_of_time(table, stated_unit_of_time([*comments, *above]))
    return _with_counted_time(table, axis[1], axis[2]) if axis else table


def _is_part(page: Page, row: int) -> bool:
    """Tell whether a line is a part of a row; a key with its value and a date are none."""
    first = page.writing.cells(page.lines.texts[row])[0]
    return bool(_LIKE_NUMBER.fullmatch(first)) and kind_of(first, page.writing.decimal) != "stamp"


def _left_out(page: Page, block: Block) -> tuple[str, ...]:
    """Say which lines above and below the rows were left out although they hold numbers or text."""
    notes = []
    numbers, kinds = page.lines.numbers, page.kinds
    for k in range(block.above, block.first):
        whole = kinds.kinds[k] == NUMERIC
        if whole and kinds.counts[k] != block.count and _is_part(page, k):
            if block.stop - block.first < ENOUGH_ROWS:
                raise page.unequal(block.first, k)
            notes.append(
                f"left out line {numbers[k]} above the rows, which has {kinds.counts[k]} "
                f"values where they have {block.count}"
            )
    if block.loose:
        shown = page.lines.texts[block.loose[0]].strip()[:40]
        many = f"{len(block.loose)} lines" if len(block.loose) > 1 else "the line"
        notes.append(
            f"left out {many} below the rows, at line {numbers[block.loose[0]]}: {shown!r}"
        )
    return tuple(notes)


def _columns(page: Page, block: Block, odd: frozenset[int]) -> list[ColumnOfCells]:
    texts, writing = page.lines.texts, page.writing
    rows = range(block.first, block.stop)
    values = None if odd else parse_regular(texts[block.first : block.stop], writing)
    if values is not None and values.shape[0] == block.count and np.isfinite(values).all():
        return [ColumnOfCells(column, None) for column in values]
    empty = [""] * block.count
    cells = [empty if k in odd else writing.cells(texts[k]) for k in rows]
    columns = [read_cells(column, writing.decimal) for column in zip(*cells, strict=True)]
    return with_clocks(columns, list(zip(*cells, strict=True)))


def parse_regular(body: Sequence[str], writing: Writing) -> NDArray[np.float64] | None:
    """Parse at the speed of C when every cell is a number.

    Parameters
    ----------
    body
        Rows.
    writing
        How they are written.

    Returns
    -------
    numpy.ndarray or None
        Shape (columns, rows); None when a cell is no number.
    """
    if writing.decimal == ",":
        if any("." in line for line in body):
            return None
        body = [line.replace(",", ".") for line in body]
    try:
        values = np.loadtxt(body, delimiter=writing.separator, comments=None, ndmin=2)
    except ValueError:
        return None
    return np.ascontiguousarray(values.T) if values.shape[0] == len(body) else None


def _cut(above: list[str], axis: tuple[int, float, float] | None, writing: Writing) -> list[str]:
    """Take the cells with start and step out of the two header rows that hold them."""
    if axis is None:
        return above
    separator = writing.separator or " "
    return [separator.join(writing.cells(line)[: axis[0]]) for line in above]


def _numbered(columns: Sequence[ColumnOfCells]) -> Titles:
    names = tuple(column.name or f"column {k}" for k, column in enumerate(columns))
    return Titles(names, names, ("",) * len(columns))


def _joined(
    source: str, titles: Titles, columns: Sequence[ColumnOfCells], numbers: NDArray[np.intp]
) -> Table:
    """Join titles and columns; a unit in the cells and one in the header must agree."""
    doubts, units = dict(titles.doubts), list(titles.units)
    for k, column in enumerate(columns):
        column.values.flags.writeable = False
        if column.unit and units[k] and column.unit != units[k] and not column.stamps:
            doubts[k] = f"its header says {units[k]!r} and its cells {column.unit!r}"
        units[k] = column.unit or units[k]
    return Table(
        source=source,
        names=titles.names,
        units=tuple(units),
        columns=tuple(column.values for column in columns),
        headers=titles.headers,
        flaws=tuple(column.flaw for column in columns),
        lines=numbers,
        aliases=titles.aliases,
        doubts=doubts,
        notes_of_columns={k: column.notes for k, column in enumerate(columns) if column.notes},
    )


def _with_unit_of_time(table: Table, unit: str) -> Table:
    """Give the unit that stands above the columns to those of the time that have none."""
    bare = [
        k
        for k, name in enumerate(table.names)
        if unit and not table.units[k] and is_time(name) and not unit_of_time_in_name(name)
    ]
    told = dict.fromkeys(bare, (f"its unit {unit} stands above the columns",))
    return replace(
        table,
        units=tuple(unit if k in told else each for k, each in enumerate(table.units)),
        notes_of_columns={
            k: (*table.notes_of_columns.get(k, ()), *told.get(k, ()))
            for k in {*table.notes_of_columns, *told}
        },
    )


def _with_counted_time(table: Table, start: float, step: float) -> Table:
    """Turn the first column into seconds where it counts the samples."""
    counts = table.columns[0]
    if counts.size > 1 and not np.array_equal(np.diff(counts), np.ones(counts.size - 1)):
        return table
    time = start + step * counts
    time.flags.writeable = False
    return replace(
        table,
        columns=(time, *table.columns[1:]),
        units=("s", *table.units[1:]),
        notes_of_columns={
            **table.notes_of_columns,
            0: (f"counts samples; start {start:.6g} s and step {step:.6g} s are in its header",),
        },
    )


def _refuse_odd_header(page: Page, block: Block) -> None:
    """Refuse a header right above the rows that has another number of cells."""
    texts = [k for k in range(block.above, block.first) if not _is_part(page, k)]
    if not texts or page.kinds.kinds[texts[-1]] == NUMERIC or page.writing.separator is None:
        return
    row = texts[-1]
    named = len(page.writing.cells(page.lines.texts[row]))
    if named > 1:
        hint = ""
        if 2 * named == block.count and page.writing.separator == ",":
            hint = "; if commas are the decimal sign too, write the file with another separator"
        raise InputError(
            f"{page.source}: line {page.lines.numbers[row]} names {named} columns, but the lines "
            f"below it have {block.count} values; correct it or make it a comment with #{hint}"
        )


def _refuse_header_among_rows(page: Page, block: Block) -> None:
    """Refuse a line of text among rows that have no header: it may be theirs, with their units."""
    for row in block.faulty:
        if page.kinds.counts[row] == block.count and page.kinds.kinds[row] == TEXT:
            raise InputError(
                f"{page.source}: line {page.lines.numbers[row]} holds {block.count} texts among "
                "rows that have no header; put it above them, or make it a comment with #"
            )


def _refuse_doubtful_row(page: Page, block: Block) -> None:
    """Refuse a first row that may be a header with numbers in it, as ``,0,1`` or ``t,1,2``."""
    texts, writing = page.lines.texts, page.writing
    second = min(block.first + 1, block.stop - 1)
    pairs = zip(writing.cells(texts[block.first]), writing.cells(texts[second]), strict=False)
    for column, (cell, below) in enumerate(pairs):
        missing = is_missing(cell) and (cell or column)
        if not missing and not writing.has_value(cell) and writing.is_number(below):
            raise InputError(
                f"{page.source}: line {page.lines.numbers[block.first]} has {cell!r} above the "
                f"number {below}, so it is neither a header nor a row of numbers; correct it, or "
                "make it a comment with #"
            )

"""Read columns of numbers from a text file."""

from __future__ import annotations

from dataclasses import replace

from hyst.errors import InputError
from hyst.io.decoding import decode
from hyst.io.line_kinds import sort_lines
from hyst.io.lvm import is_lvm, lvm_segments
from hyst.io.notation import Writing, find_writing
from hyst.io.table import Table
from hyst.io.text_block import Page, table_of_block
from hyst.io.text_lines import Lines, significant_lines
from hyst.io.text_tables import find_blocks
from hyst.io.trailing_separators import drop_trailing_separators

SUFFIXES = (".csv", ".tsv", ".txt", ".dat", ".asc", ".tab", ".prn", ".lvm", ".log")


def read_text(data: bytes, source: str, repair: bool = False) -> tuple[Table, ...]:
    """Read the tables of a text file.

    Cells are separated by tabs, semicolons, commas, bars or white space, numbers have a decimal
    point or comma; both are found out from the file. Blank lines and lines that start with ``#``,
    ``%`` or ``//`` are skipped. Headers are optional and may stand in the last comment line.

    Parameters
    ----------
    data
        Content of the file.
    source
        Name of the file, for messages.
    repair
        Make lines with another number of cells rows without values, instead of refusing them.

    Returns
    -------
    tuple of Table
        Those that stand below each other, mostly one; what is no number is NaN.

    Raises
    ------
    InputError
        If the file is not text, holds no numbers, or its lines have different numbers of cells.
    """
    text = decode(data, source)
    if is_lvm(text):
        segments = lvm_segments(text, source)
    else:
        lines = significant_lines(text)
        if not lines.texts:
            raise _no_numbers(source)
        segments = [(lines, find_writing(lines.texts), None)]
    return tuple(table for each in segments for table in _tables(*each, source, repair))


def _tables(
    lines: Lines, writing: Writing, step: float | None, source: str, repair: bool
) -> tuple[Table, ...]:
    texts = drop_trailing_separators(lines.texts, writing)
    kinds = sort_lines(texts, writing)
    blocks = find_blocks(texts, kinds, lines.after_gap, writing, lines.comments)
    if not blocks:
        raise _no_numbers(source)
    page = Page(source, replace(lines, texts=texts), kinds, writing)
    return tuple(table_of_block(page, block, repair, step) for block in blocks)


def _no_numbers(source: str) -> InputError:
    return InputError(f"{source} holds no line of numbers; give a file with columns of numbers")

"""Find out how a text file is written: separator, decimal sign, header, first row of data."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass

from hyst.errors import InputError
from hyst.io.header import bracketed

_SAMPLED = 200
_POINT = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_COMMA = re.compile(r"[+-]?(\d+(,\d+)?|,\d+)([eE][+-]?\d+)?", re.ASCII)
_FRACTION = re.compile(r",0\d|[eE]")
_MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "inf", "+inf", "-inf"})
_QUOTED_OR_BARE = re.compile(r'"[^"]*"|\S+')
_NAMED = re.compile(r'\[[^\]]*\]|\([^)]*\)|(?:"[^"]*"|[^\s\[(]\S*)(?:\s*(?:\[[^\]]*\]|\([^)]*\)))?')


@dataclass(frozen=True)
class Writing:
    """Separator between cells (None: white space) and decimal sign.

    Parameters
    ----------
    separator
        One character, or None.
    decimal
        ``.`` or ``,``.
    """

    separator: str | None
    decimal: str

    def cells(self, line: str) -> list[str]:
        """Cut a line into cells, without the white space and quotes around them."""
        if self.separator is None:
            found = line.split() if '"' not in line else _QUOTED_OR_BARE.findall(line)
            return [cell.strip('"') for cell in found]
        if '"' not in line:
            return [cell.strip() for cell in line.split(self.separator)]
        reader = csv.reader([line], delimiter=self.separator, skipinitialspace=True)
        try:
            return [cell.strip() for cell in next(reader)]
        except csv.Error:
            return [cell.strip() for cell in line.split(self.separator)]

    def titles(self, line: str) -> list[str]:
        """Cut a header line into cells; between spaces a bracket belongs to the name before.

        A header without the separator of the data is cut at its spaces.
        """
        if self.separator is not None and self.separator in line:
            return self.cells(line)
        return [cell.strip('"') for cell in _NAMED.findall(line)]

    def is_number(self, cell: str) -> bool:
        """Tell whether a cell is a number written with this decimal sign."""
        pattern = _POINT if self.decimal == "." else _COMMA
        return pattern.fullmatch(cell) is not None

    def kind(self, line: str) -> str:
        """Sort a line: ``numeric``, ``text`` (no number at all) or ``mixed``."""
        cells = self.cells(line)
        numbers = sum(self.is_number(cell) for cell in cells)
        if numbers == 0:
            return "text"
        missing = sum(cell.casefold() in _MISSING for cell in cells)
        return "numeric" if numbers + missing == len(cells) else "mixed"


# Of two that fit equally well the earlier is taken, so 1,2 is two columns and not 1.2.
_WRITINGS = (
    Writing("\t", "."),
    Writing("\t", ","),
    Writing(";", "."),
    Writing(";", ","),
    Writing(",", "."),
    Writing(None, "."),
    Writing(None, ","),
    Writing(",", ","),
)


def drop_trailing_separators(lines: list[str], writing: Writing) -> list[str]:
    """Drop the separator at the end of every line, which some instruments write.

    Parameters
    ----------
    lines
        Lines without comments and blank ones.
    writing
        How they are written.

    Returns
    -------
    list of str
        The lines as they were unless all of them, headers aside, end with a separator.

    Examples
    --------
    >>> drop_trailing_separators(["u;y", "1;2;", "3;4;"], Writing(";", "."))
    ['u;y', '1;2', '3;4']
    """
    separator = writing.separator
    if separator is None or not lines[-1].rstrip(" ").endswith(separator):
        return lines
    others = [line for line in lines if not line.rstrip(" ").endswith(separator)]
    if len(others) > _SAMPLED or any(writing.kind(line) != "text" for line in others):
        return lines
    return [line.rstrip(" ").removesuffix(separator) for line in lines]


def find_writing(lines: list[str]) -> Writing:
    """Choose the separator and decimal sign under which most cells are numbers.

    Parameters
    ----------
    lines
        Lines without comments and blank ones, at least one.

    Returns
    -------
    Writing
        The choice, from some 400 lines: the last 200 (the first may be a preamble) and 200
        spread over the file.
    """
    stride = max(1, len(lines) // _SAMPLED)
    sample = lines[-_SAMPLED:] + lines[::stride]
    fitting = [
        writing
        for writing in _WRITINGS
        if writing.separator is None
        or 2 * sum(writing.separator in line for line in sample) > len(sample)
    ]
    best = max(fitting, key=lambda writing: _share_of_numbers(writing, sample))
    if best == Writing(",", ".") and _is_one_column(lines, sample):
        return Writing(None, ",")
    return best


def _is_one_column(lines: list[str], sample: list[str]) -> bool:
    """Tell one column with decimal commas from two columns of whole numbers.

    The signs of it are a header of one name, a zero that leads the part after the comma, or an
    exponent.
    """
    writing = Writing(None, ",")
    numbers = [line.strip() for line in sample if writing.kind(line) != "text"]
    if not all(map(writing.is_number, numbers)):
        return False
    texts = [line for line in lines[:_SAMPLED] if writing.kind(line) == "text"]
    if texts and "," not in texts[-1] and len(writing.titles(texts[-1])) == 1:
        return True
    return any(_FRACTION.search(number) for number in numbers)


def _share_of_numbers(writing: Writing, sample: list[str]) -> float:
    """Average over the lines, so that a header counts alike however many cells it is cut into."""
    share = 0.0
    for line in sample:
        cells = [cell for cell in writing.cells(line) if cell.casefold() not in _MISSING]
        share += sum(writing.is_number(cell) for cell in cells) / max(1, len(cells))
    return share


def find_first_row(lines: list[str], writing: Writing, source: str) -> int:
    """Find the line the data start at.

    The last line of pure text before the first purely numeric line is the header if it has as
    many cells, and all before it is a preamble. Otherwise the data start at the first line with
    a number in it, so that a faulty first row is reported and not taken for a header.

    Parameters
    ----------
    lines
        Lines without comments and blank ones.
    writing
        How they are written.
    source
        Name of the file, for messages.

    Returns
    -------
    int
        Index in ``lines``.

    Raises
    ------
    InputError
        If no line holds a number.

    Examples
    --------
    >>> find_first_row(["made by, x", "u, y", "1, 2"], Writing(",", "."), "a.csv")
    2
    """
    first_with_number = None
    for row, line in enumerate(lines):
        kind = writing.kind(line)
        if kind == "text":
            continue
        if first_with_number is None:
            first_with_number = row
        if kind == "numeric":
            if row and _is_header(lines[row - 1], line, writing):
                return row
            break
        if row - first_with_number > _SAMPLED:
            break
    if first_with_number is None:
        raise InputError(f"{source} holds no line of numbers; give a file with columns of numbers")
    return first_with_number


def refuse_doubtful_row(body: list[str], writing: Writing, where: str) -> None:
    """Refuse a first row that may be a header with numbers in it, as ``,0,1`` or ``t,1,2``.

    Parameters
    ----------
    body
        The lines of data of a file without headers.
    writing
        How they are written.
    where
        File and line, for the message.

    Raises
    ------
    InputError
        If the first row has a text, or nothing in its first cell, where the second has a number.
    """
    first, second = writing.cells(body[0]), writing.cells(body[min(1, len(body) - 1)])
    for column, (cell, below) in enumerate(zip(first, second, strict=False)):
        missing = cell.casefold() in _MISSING and (cell or column)
        if not missing and not writing.is_number(cell) and writing.is_number(below):
            raise InputError(
                f"{where} has {cell!r} above the number {below}, so it is neither a header nor a "
                "row of numbers; correct it, or make it a comment with #"
            )


def _is_header(line: str, data: str, writing: Writing) -> bool:
    if writing.kind(line) != "text":
        return False
    count = len(writing.cells(data))
    return count in {len(writing.titles(line)), len(writing.cells(line))} or count == 1


def find_titles(above: list[str], comment: str, count: int, writing: Writing) -> list[str] | None:
    """Find the headers of the columns.

    Parameters
    ----------
    above
        The lines before the data.
    comment
        The last comment before the data without its sign; empty if there is none.
    count
        Number of columns.
    writing
        How the file is written.

    Returns
    -------
    list of str or None
        One header a column. A row of units in brackets is joined to the row of names above it.
        None if there are no headers, or not as many as columns.
    """
    titles = _as_many(above[-1] if above else comment, count, writing)
    if titles is not None and not above and not all(titles):
        return None  # a comment that happens to hold separators
    if titles is None or any(writing.is_number(title) for title in titles):
        return None
    if len(above) > 1 and bracketed(titles):
        names = _as_many(above[-2], count, writing)
        if names is not None:
            return [f"{name} {unit}".strip() for name, unit in zip(names, titles, strict=True)]
    return titles


def _as_many(line: str, count: int, writing: Writing) -> list[str] | None:
    for titles in (writing.titles(line), writing.cells(line)):
        while len(titles) > count and not titles[-1]:
            titles.pop()
        if len(titles) == count and any(titles):
            return titles
    whole = line.strip().strip('"').strip()
    return [whole] if count == 1 and whole else None

"""How the cells of a text file are written: the separator between them and the decimal sign."""

from __future__ import annotations

import csv
import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass

from hyst.io.cells import is_missing, kind_of, number_pattern

SAMPLED = 200
_FRACTION = re.compile(r",0\d|[eE]")
_QUOTED_OR_BARE = re.compile(r'"[^"]*"|\S+')
_NAMED = re.compile(r'\[[^\]]*\]|\([^)]*\)|(?:"[^"]*"|[^\s\[(]\S*)(?:\s*(?:\[[^\]]*\]|\([^)]*\)))?')
# What is less plain than a number counts a little less, so that of two ways to cut a line that
# with more plain numbers is taken.
_LESS_PLAIN = 0.9
_OF_A_HEADER = 0.5
# A date and a clock with a blank between them are one stamp.
_DATE_AND_CLOCK = re.compile(
    r"(\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{4}) +(\d{1,2}:\d{2}:\d{2})"
)


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
            if ":" in line:
                line = _DATE_AND_CLOCK.sub(r"\1T\2", line)
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
        """Tell whether a cell is a plain number written with this decimal sign."""
        return number_pattern(self.decimal).fullmatch(cell) is not None

    def has_value(self, cell: str) -> bool:
        """Tell whether a cell is a number, plain or not, or a time stamp."""
        return kind_of(cell, self.decimal) != "text"

    def kind(self, line: str) -> str:
        """Sort a line: ``numeric``, ``text`` (no value at all) or ``mixed``."""
        cells = self.cells(line)
        values = sum(self.has_value(cell) for cell in cells)
        if values == 0:
            return "text"
        missing = sum(is_missing(cell) for cell in cells)
        return "numeric" if values + missing == len(cells) else "mixed"


# Of two that fit equally well the earlier is taken, so 1,2 is two columns and not 1.2.
_WRITINGS = (
    Writing("\t", "."),
    Writing("\t", ","),
    Writing(";", "."),
    Writing(";", ","),
    Writing(",", "."),
    Writing("|", "."),
    Writing(None, "."),
    Writing(None, ","),
    Writing(",", ","),
)


def find_writing(lines: Sequence[str]) -> Writing:
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
    stride = max(1, len(lines) // SAMPLED)
    sample = [*lines[-SAMPLED:], *lines[::stride]]
    fitting = [
        writing
        for writing in _WRITINGS
        if writing.separator is None
        or 2 * sum(writing.separator in line for line in sample) > len(sample)
    ]
    best = fitting[0] if _is_best(fitting, sample) else _best_of(fitting, sample)
    if best == Writing(",", ".") and _is_one_column(lines, sample):
        return Writing(None, ",")
    return best


def _is_best(fitting: Sequence[Writing], sample: Sequence[str]) -> bool:
    """Tell whether the first is the best, by the lines that are not all numbers under it.

    On the others no writing has a larger share, so that most files are cut in one way only.
    """
    first, *others = fitting
    left = [line for line in sample if _share_of_values(first, [line]) < 1.0]
    own = _share_of_values(first, left)
    return first.separator is not None and all(
        _share_of_values(each, left) <= own for each in others
    )


def _best_of(fitting: Sequence[Writing], sample: Sequence[str]) -> Writing:
    shares = {writing: _share_of_values(writing, sample) for writing in fitting}
    best = max(fitting, key=lambda writing: shares[writing])
    if best.separator is None:
        # Of a header in words, blanks may cut out a number; that is no evidence.
        best = next(w for w in fitting if shares[w] >= shares[best] - _OF_A_HEADER)
    return best


def _is_one_column(lines: Sequence[str], sample: list[str]) -> bool:
    """Tell one column with decimal commas from two columns of whole numbers.

    The signs of it are a header of one name, a zero that leads the part after the comma, or an
    exponent.
    """
    writing = Writing(None, ",")
    numbers = []
    for line in map(str.strip, sample):
        if writing.is_number(line):
            numbers.append(line)
        elif writing.kind(line) != "text":
            return False
    if not numbers:
        return False
    texts = list(itertools.takewhile(lambda line: writing.kind(line) == "text", lines[:SAMPLED]))
    if texts and "," not in texts[-1] and len(writing.titles(texts[-1])) == 1:
        return True
    return any(_FRACTION.search(number) for number in numbers)


def _share_of_values(writing: Writing, sample: Sequence[str]) -> float:
    """Average over the lines, so that a header counts alike however many cells it is cut into."""
    share = 0.0
    for line in sample:
        cells = [cell for cell in writing.cells(line) if not is_missing(cell)]
        plain = sum(writing.is_number(cell) for cell in cells)
        values = plain if plain == len(cells) else sum(map(writing.has_value, cells))
        share += (plain + _LESS_PLAIN * (values - plain)) / max(1, len(cells))
    return share

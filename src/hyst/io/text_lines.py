"""The lines of a text file that mean something, with their numbers."""

from __future__ import annotations

import re
from dataclasses import dataclass

from hyst.io.known_units import is_unit

# The last is how a spreadsheet is told the separator.
COMMENTS = ("#", "%", "//", "sep=")
# What spreadsheets write for a value they could not compute: a fault in a row, not a comment.
_SPREADSHEET_ERRORS = ("#N/A", "#DIV/0!", "#VALUE!", "#REF!", "#NAME?", "#NUM!", "#NULL!")
# A header may have line breaks in quotes; further down an odd quote is a fault.
_HEAD = 200
_LONGEST_QUOTE = 6
_LETTERS = re.compile(r"[^\W\deE_]")
_WORDS = re.compile(r"[^\W\d_]\w*(?![^\[]*\])(?![^(]*\))")
_FIRST_COMMENT_CELL = re.compile(r"^(?:#|%|//)+\s?")


@dataclass(frozen=True)
class Lines:
    """Lines that are neither blank nor comments; and headers that stand again, as comments too.

    Parameters
    ----------
    texts
        The lines.
    numbers
        The line of the file at which each stands, from 1.
    comments
        Comments before the first of them, without their sign.
    after_gap
        Indices of lines above which there is a blank line or a comment.
    """

    texts: list[str]
    numbers: list[int]
    comments: tuple[str, ...]
    after_gap: frozenset[int]


def significant_lines(text: str) -> Lines:
    r"""Drop blank lines and comments, and join header lines that are broken inside quotes.

    Parameters
    ----------
    text
        Content of the file, lines ended by a line feed.

    Returns
    -------
    Lines

    Examples
    --------
    >>> found = significant_lines('# by hand\n"time\n[s]",u\n\n0,1\n')
    >>> found.texts, found.numbers, found.comments
    (['"time [s]",u', '0,1'], [2, 5], ('by hand',))
    """
    numbers: list[int] = []
    lines: list[str] = []
    comments: list[str] = []
    after_gap: set[int] = set()
    headers: set[str] = set()
    for number, line in _joined(text.split("\n")):
        start = line.lstrip()
        if is_comment(start):
            after_gap.add(len(lines))
            comment = _FIRST_COMMENT_CELL.sub("", start).strip()
            if not lines:
                comments.append(comment)
            elif _is_header_again(comment, comments, lines[0]) or (
                numbers[-1] == number - 1 and lines[-1] in headers and _all_units(comment)
            ):
                # As numpy.savetxt writes it, appending to a file.
                numbers.append(number)
                lines.append(comment)
                headers.add(comment)
        elif start:
            numbers.append(number)
            lines.append(line)
        else:
            after_gap.add(len(lines))
    return Lines(lines, numbers, tuple(comments), frozenset(after_gap))


def is_comment(line: str) -> bool:
    """Tell whether a line says nothing to a program."""
    start = line.lstrip()
    return start.startswith(COMMENTS) and not start.startswith(_SPREADSHEET_ERRORS)


def _is_header_again(comment: str, comments: list[str], first: str) -> bool:
    """Tell whether a comment names what the header in the comments above the first line names."""
    if not comments or _LETTERS.search(first):
        return False  # the header is no comment
    below = len(comments) > 1 and _all_units(comments[-1])
    header = _names_in(comments[-2 if below else -1])
    return len(header) > 1 and _names_in(comment) == header


def _all_units(comment: str) -> bool:
    return all(map(is_unit, re.split(r"[\s,;|]+", comment)))


def _names_in(comment: str) -> list[str]:
    """Give the names in a header in any order, without their units in brackets."""
    return sorted(map(str.casefold, _WORDS.findall(comment)))


def _joined(lines: list[str]) -> list[tuple[int, str]]:
    """Give the lines with their numbers, joined where a quote goes over a break in the head."""
    numbered = list(enumerate(lines, 1))
    head: list[tuple[int, str]] = []
    row = 0
    while row < min(_HEAD, len(lines)):
        number, line = numbered[row]
        row += 1
        if line.count('"') % 2:
            end = _end_of_quote(lines, row)
            line = " ".join([line, *(each.strip() for each in lines[row:end])])
            row = end
        head.append((number, line))
    return [*head, *numbered[row:]]


def _end_of_quote(lines: list[str], start: int) -> int:
    """Give the line after that in which an open quote is closed; ``start`` if none is near."""
    for row in range(start, min(start + _LONGEST_QUOTE, len(lines))):
        if lines[row].count('"') % 2:
            return row + 1
    return start

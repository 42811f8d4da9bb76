"""The headers of the columns of a text file: names, units, and other rows above the numbers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from hyst.io.header import bracketed, is_time, split_unit, unit_of_time_in_name
from hyst.io.known_units import is_unit
from hyst.io.notation import Writing
from hyst.io.units_of_time import seconds_per_unit
from hyst.signals import units_differ

_ROWS = 4
_LABELS = frozenset({"unit", "units", "einheit", "einheiten"})
_RULE = re.compile(r"[\s|+:;,=*_~-]*[|+:=*_~-]{2}[\s|+:;,=*_~-]*")


@dataclass(frozen=True)
class Titles:
    """What the rows above the numbers say about the columns.

    Parameters
    ----------
    headers
        One for each column, as it stands in the row of names, with the unit of a row of units.
    names, units
        The same taken apart.
    aliases
        Other rows of text, in which a column may be looked up too.
    doubts
        By column, why its unit cannot be relied on.
    """

    headers: tuple[str, ...]
    names: tuple[str, ...]
    units: tuple[str, ...]
    aliases: tuple[tuple[str, ...], ...] = ()
    doubts: dict[int, str] = field(default_factory=dict)


def find_titles(
    above: Sequence[str], comments: Sequence[str], count: int, writing: Writing
) -> Titles | None:
    """Find the headers of the columns.

    Parameters
    ----------
    above
        The lines before the numbers.
    comments
        The comments before them without their sign.
    count
        Number of columns.
    writing
        How the file is written.

    Returns
    -------
    Titles or None
        None if there are no headers, or not as many as columns.

    Examples
    --------
    >>> found = find_titles(["t,u", "ms,V"], (), 2, Writing(",", "."))
    >>> found.headers, found.names, found.units
    (('t [ms]', 'u [V]'), ('t', 'u'), ('ms', 'V'))
    """
    rows = _rows(above, count, writing)
    if not rows and not above:
        rows = _rows(comments, count, writing, whole=True)
    if not rows:
        return None
    units = next((k for k, row in enumerate(rows) if _is_row_of_units(row)), None)
    if units is None or len(rows) == 1:
        if any(writing.is_number(title) for title in rows[0]):
            return None
        # The row that carries units is that of the names; a row of text below it may be anything.
        texts = [row for row in rows if not any(map(writing.has_value, row))] or rows[:1]
        best = max(texts, key=lambda row: sum(bool(split_unit(cell)[1]) for cell in row))
        return _titles(best, None, tuple(tuple(row) for row in texts if row is not best))
    names = units + 1 if units + 1 < len(rows) else 0
    if all(map(writing.is_number, rows[names])):
        return _titles(rows[units], None, ())
    others = [row for k, row in enumerate(rows) if k not in (names, units)]
    return _titles(rows[names], rows[units], _descriptions(others, writing))


def _rows(
    lines: Sequence[str], count: int, writing: Writing, whole: bool = False
) -> list[list[str]]:
    """Give the rows with as many cells as there are columns, from the numbers upwards."""
    rows: list[list[str]] = []
    for line in reversed(lines[-_ROWS:]):
        cells = _as_many(line, count, writing)
        if (cells is None and len(writing.cells(line)) == 1) or _RULE.fullmatch(line):
            continue  # a rule below the names, or a remark
        if cells is None or (whole and not all(cells)):
            break
        rows.append(cells)
        if count == 1:
            break
    return rows


def _is_row_of_units(cells: list[str]) -> bool:
    """Tell whether all cells of a row are units, or all are in brackets; some may be empty."""
    written = [cell for cell in cells if cell and cell.casefold().strip(":") not in _LABELS]
    if not written:
        return False
    if bracketed(cells):
        return True
    if not all(map(is_unit, written)):
        units = sum(is_unit(cell) and cell[-1].isalpha() for cell in written)
        return units > 1 and 3 * units >= 2 * len(cells)
    return 2 * len(written) >= len(cells)


def _descriptions(rows: Sequence[list[str]], writing: Writing) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(row) for row in rows if not any(map(writing.has_value, row)))


def _titles(
    names: list[str], units: list[str] | None, aliases: tuple[tuple[str, ...], ...]
) -> Titles:
    split = [split_unit(name) for name in names]
    if units is None:
        own = [
            unit or _unit_of_time([names[column], *(row[column] for row in aliases)])
            for column, (_, unit) in enumerate(split)
        ]
        return Titles(tuple(names), tuple(name for name, _ in split), tuple(own), aliases)
    headers, own_names, own_units, doubts = [], [], [], {}
    for column, (header, (name, unit), below) in enumerate(zip(names, split, units, strict=True)):
        stated = _bare(below)
        known = unit or unit_of_time_in_name(header)
        if known and stated and _contradict(known, stated):
            doubts[column] = f"its header says {known!r} and the row of units {stated!r}"
        headers.append(f"{header} [{stated}]" if stated and not unit else header)
        own_names.append(name)
        own_units.append(stated or unit)
    return Titles(tuple(headers), tuple(own_names), tuple(own_units), aliases, doubts)


def _unit_of_time(cells: Sequence[str]) -> str:
    """Find the unit of a time among all texts above a column; to miss it would be a wrong step."""
    split = [split_unit(cell) for cell in cells]
    if len(cells) > 1 and any(is_time(name) for name, _ in split):
        for unit in (*(unit for _, unit in split), *map(_bare, cells)):
            if unit and seconds_per_unit(unit) is not None:
                return unit
    return ""


def _bare(unit: str) -> str:
    text = unit.strip()
    if len(text) > 1 and (text[0], text[-1]) in {("(", ")"), ("[", "]"), ("<", ">"), ("{", "}")}:
        text = text[1:-1].strip()
    return text


def _contradict(unit: str, other: str) -> bool:
    seconds, others = seconds_per_unit(unit), seconds_per_unit(other)
    if seconds is not None and others is not None:
        return seconds != others
    return units_differ(unit, other) and is_unit(unit) and len(unit) < 4 and len(other) < 4


def _as_many(line: str, count: int, writing: Writing) -> list[str] | None:
    for titles in (writing.titles(line), writing.cells(line)):
        while len(titles) > count and not titles[-1]:
            titles.pop()
        if len(titles) == count and any(titles):
            return titles
    whole = line.strip().strip('"').strip()
    return [whole] if count == 1 and whole else None

"""Cut a LabVIEW measurement file (.lvm) into its segments."""

from __future__ import annotations

import math
from collections.abc import Iterator

from hyst.errors import InputError
from hyst.io.notation import Writing, find_writing
from hyst.io.text_lines import Lines

_FIRST = "LabVIEW Measurement"
_END = "***End_of_Header***"
_SPECIAL, _END_SPECIAL = "***Start_Special***", "***End_Special***"
_X, _COMMENT = "x_value", "comment"
Segment = tuple[Lines, Writing, float | None]


def is_lvm(text: str) -> bool:
    """Tell whether a text is a LabVIEW measurement file, by its first line."""
    return text.lstrip().startswith(_FIRST)


def lvm_segments(text: str, source: str) -> list[Segment]:
    r"""Give each segment as lines of a plain table.

    What the file does not write, because it states start and step of the time instead, is put in
    as a column ``X_Value``; comments of rows are dropped.

    Parameters
    ----------
    text
        Content of the file.
    source
        Name of the file, for messages.

    Returns
    -------
    list of tuple
        Names, units and rows of each segment, how they are written, and the stated step, seconds.

    Raises
    ------
    InputError
        If no segment has a row.

    Examples
    --------
    >>> text = "LabVIEW Measurement\n***End_of_Header***\n\nDelta_X\t0.5\n***End_of_Header***\n"
    >>> lines, _, step = lvm_segments(text + "X_Value\tu\tComment\n\t1\n\t2\n", "a.lvm")[0]
    >>> lines.texts, step
    (['X_Value\tu', '0.0\t1', '0.5\t2'], 0.5)
    """
    lines = list(enumerate(text.split("\n"), 1))
    end = next((k for k, (_, line) in enumerate(lines) if line.strip().startswith(_END)), None)
    if end is None:
        raise InputError(
            f"{source} is a LabVIEW measurement file without ***End_of_Header***; save it again"
        )
    said = _entries([line for _, line in lines[:end]])
    separator = "," if said.get("separator", [""])[0].casefold() == "comma" else "\t"
    decimal = said.get("decimal_separator", [""])[0].strip()
    segments = []
    for head, body in _cut(_without_specials(lines[end + 1 :])):
        known = decimal or find_writing([line for _, line in body[1:]]).decimal
        segment = _segment(head, body, Writing(separator, known))
        if segment is not None:
            segments.append(segment)
    if not segments:
        raise InputError(f"{source} holds no segment with rows of numbers; save it again")
    return segments


def _entries(lines: list[str]) -> dict[str, list[str]]:
    """Read a header: the first cell is the key."""
    cut = [line.replace(",", "\t", 1) if "\t" not in line else line for line in lines]
    cells = [[cell.strip() for cell in line.split("\t")] for line in cut]
    return {row[0].casefold(): row[1:] for row in cells if row[0] and len(row) > 1}


def _without_specials(lines: list[tuple[int, str]]) -> list[tuple[int, str]]:
    kept, special = [], False
    for number, line in lines:
        special = special or line.strip().startswith(_SPECIAL)
        if not special:
            kept.append((number, line))
        special = special and not line.strip().startswith(_END_SPECIAL)
    return kept


def _cut(
    lines: list[tuple[int, str]],
) -> Iterator[tuple[list[str], list[tuple[int, str]]]]:
    """Give header lines and the lines below them, of each segment with a row of names."""
    head: list[str] = []
    body: list[tuple[int, str]] = []
    for number, line in lines:
        first = line.strip().split("\t")[0].split(",")[0].strip().casefold()
        if first == "channels" and body:
            yield head, body
            head, body = [], []
        if line.strip().startswith(_END):
            head, body = [each for _, each in body], []
        elif line.strip():
            body.append((number, line))
    if body:
        yield head, body


def _segment(head: list[str], body: list[tuple[int, str]], writing: Writing) -> Segment | None:
    said = _entries(head)
    names = [cell.strip() for cell in writing.cells(body[0][1])]
    while names and (not names[-1] or names[-1].casefold() == _COMMENT):
        names.pop()
    rows = [writing.cells(line) for _, line in body[1:]]
    if len(names) < 2 or not rows:
        return None
    start, step = (_first(said, key, writing) for key in ("x0", "delta_x"))
    if names[0].casefold() == _X and step is not None and all(not row[0] for row in rows):
        rows = [[_written(start, step, k, writing), *row[1:]] for k, row in enumerate(rows)]
    separator = writing.separator or "\t"
    units = _units(names, said.get("y_unit_label", []), said.get("x_dimension", []))
    top = [separator.join(names)] + ([separator.join(units)] if any(units) else [])
    texts = [*top, *(separator.join(_fitted(row, len(names))) for row in rows)]
    numbers = [body[0][0]] * len(top) + [number for number, _ in body[1:]]
    return Lines(texts, numbers, (), frozenset()), writing, step


def _fitted(row: list[str], count: int) -> list[str]:
    """Cut a row at its comment; a row too short stays so."""
    return row[:count]


def _first(said: dict[str, list[str]], key: str, writing: Writing) -> float | None:
    for cell in said.get(key, []):
        try:
            value = float(cell.replace(",", "."))
        except ValueError:
            continue
        if math.isfinite(value):
            return value if key == "x0" or value > 0.0 else None
    return None


def _written(start: float | None, step: float, row: int, writing: Writing) -> str:
    return repr((start or 0.0) + row * step).replace(".", writing.decimal)


def _units(names: list[str], labels: list[str], dimensions: list[str]) -> list[str]:
    """Give the unit of each column: seconds for times, the label of its channel for the others."""
    units, channel = [], 0
    time = not dimensions or dimensions[0].casefold() in ("time", "")
    for name in names:
        if name.casefold() == _X:
            units.append("s" if time and labels else "")
        else:
            units.append(labels[channel] if channel < len(labels) else "")
            channel += 1
    return units

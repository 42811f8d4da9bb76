"""Take the unit out of a column header."""

from __future__ import annotations

import re

_PATTERNS = (
    re.compile(r"(?P<name>.*[^\s/])\s*\[(?P<unit>[^\[\]]*)\]"),
    re.compile(r"(?P<name>.*[^\s/])\s*\((?P<unit>[^()]*)\)"),
    re.compile(r"(?P<name>[^/]*[^/\s])\s*/\s*\((?P<unit>[^()]*)\)"),
    re.compile(r"(?P<name>[^/]*[^/\s])\s*/\s*(?P<unit>\S{1,12})"),
)


def split_unit(header: str) -> tuple[str, str]:
    """Split ``voltage [V]``, ``voltage (V)`` or ``voltage/V`` into name and unit.

    Parameters
    ----------
    header
        Text of a header cell.

    Returns
    -------
    tuple of str
        Name and unit; the whole header and nothing where no unit is seen. A number in brackets
        is an index and not a unit.

    Examples
    --------
    >>> split_unit("voltage [V]"), split_unit("speed/m/s"), split_unit("x[0]")
    (('voltage', 'V'), ('speed', 'm/s'), ('x[0]', ''))
    """
    for pattern in _PATTERNS:
        found = pattern.fullmatch(header)
        if found and not found["unit"].strip().isdigit():
            return found["name"], found["unit"].strip()
    return header, ""


def bracketed(cells: list[str]) -> bool:
    """Tell whether a row holds nothing but units in brackets, as ``(ms);(V)``."""
    written = [cell for cell in cells if cell]
    return bool(written) and all(
        (cell[0], cell[-1]) in {("(", ")"), ("[", "]")} for cell in written
    )

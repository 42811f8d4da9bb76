"""Take the unit out of a column header."""

from __future__ import annotations

import re

from hyst.io.known_units import is_unit, is_word
from hyst.io.units_of_time import seconds_per_unit

_BRACKETED = (
    re.compile(r"(?P<name>.*[^\s/])\s*\[(?P<unit>[^\[\]]*)\]"),
    re.compile(r"(?P<name>.*[^\s/])\s*\((?P<unit>[^()]*)\)"),
    re.compile(r"(?P<name>.*[^\s/])\s*[<{](?P<unit>[^<>{}]*)[>}]"),
    re.compile(r"(?P<name>[^/]*[^/\s])\s*/\s*\((?P<unit>[^()]*)\)"),
    re.compile(r"(?P<name>[^/]*[^/\s])\s*/\s*(?P<unit>\S{1,12})"),
)
_IN_WORDS = re.compile(r"(?P<name>.*\S)(?P<sign>\s+in\s+)(?P<unit>\S+)")
# Without brackets only what cannot be anything else is a unit.
_LOOSE = re.compile(r"(?P<name>.*[^\s,:;|_])(?P<sign>\s*[,:;|]\s*|\s+|_)(?P<unit>[^\s_]+)")
_TIME = re.compile(
    r"(?:.*[\s_./:-])?(?:time|t|timestamp|timestamps|zeit|temps|tiempo|tempo|tijd|elapsed|clock|"
    r"ticks?|stamps?|runtime|x_value|x-axis)(?:[\s_]?(?:rel|abs|since.*|stamp|axis|\d+))?",
    re.IGNORECASE,
)
_CURRENT = re.compile(r".*(?:current|strom|courant|i|i\d+)", re.IGNORECASE)
_FORCE = re.compile(r".*(?:force|load|kraft|f|f\d+)", re.IGNORECASE)
_NOT_SINGLE = re.compile(
    r".*(?:channel|ch|kanal|phase|probe|sensor|axis|coil|input|output|port|line|trace|curve|side|"
    r"leg|pin|group|signal|record|step|data)s?",
    re.IGNORECASE,
)
_LEADING = re.compile(r"in\s+", re.IGNORECASE)


def split_unit(header: str) -> tuple[str, str]:
    """Split ``voltage [V]``, ``voltage (V)``, ``voltage/V`` or ``voltage_mV`` into name and unit.

    Parameters
    ----------
    header
        Text of a header cell.

    Returns
    -------
    tuple of str
        Name and unit; the whole header and nothing where no unit is seen. A number in brackets
        is an index and not a unit. What follows a blank, a comma or an underscore is a unit only
        where it is one that hyst knows.

    Examples
    --------
    >>> split_unit("voltage [V]"), split_unit("speed/m/s"), split_unit("x[0]")
    (('voltage', 'V'), ('speed', 'm/s'), ('x[0]', ''))
    >>> split_unit("time_ms"), split_unit("stroke, um"), split_unit("x_in")
    (('time', 'ms'), ('stroke', 'um'), ('x_in', ''))
    """
    for pattern in _BRACKETED:
        found = pattern.fullmatch(header)
        if found and _may_be_unit(header, found):
            return found["name"], _LEADING.sub("", found["unit"].strip())
    for pattern in (_IN_WORDS, _LOOSE):
        loose = pattern.fullmatch(header)
        if loose and _is_plain_unit(loose["name"], loose["unit"], loose["sign"]):
            return loose["name"], loose["unit"]
    return header, ""


def is_time(name: str) -> bool:
    """Tell whether a column is called as times are.

    Examples
    --------
    >>> is_time("Time"), is_time("t_pos"), is_time("elapsed time"), is_time("travel")
    (True, False, True, False)
    """
    return _TIME.fullmatch(name.strip()) is not None


def unit_of_time_in_name(name: str) -> str:
    """Give the unit of time that a column's name carries without being split off.

    Examples
    --------
    >>> unit_of_time_in_name("timeMs"), unit_of_time_in_name("micros"), unit_of_time_in_name("t")
    ('Ms', 'micros', '')
    """
    bare = name.strip()
    if bare and seconds_per_unit(bare) is not None:
        return bare
    words = re.findall(r"[A-Z]?[^\W\d_A-Z]+|[A-Z]+(?![a-z])", bare)
    if len(words) > 1 and seconds_per_unit(words[-1]) is not None:
        return str(words[-1])
    return ""


def bracketed(cells: list[str]) -> bool:
    """Tell whether a row holds nothing but units in brackets, as ``(ms);(V)``."""
    written = [cell for cell in cells if cell]
    return bool(written) and all(
        (cell[0], cell[-1]) in {("(", ")"), ("[", "]")} for cell in written
    )


def _may_be_unit(header: str, found: re.Match[str]) -> bool:
    unit = found["unit"].strip()
    if unit.isdigit():
        return False
    # V(n001) is what a circuit simulator calls a voltage.
    attached = header[len(found["name"])] in "(<{"
    return not (attached and unit[-1:].isdigit() and not is_unit(unit))


def _is_plain_unit(name: str, unit: str, sign: str) -> bool:
    if seconds_per_unit(unit) is not None:
        sure = unit.rstrip(".").casefold() not in {"s", "h", "min", "std", "seg", "day", "days"}
        return is_time(name) or (sure and sign != " ")
    if unit == "V":
        return not _NOT_SINGLE.fullmatch(name)
    if unit in {"A", "N"}:
        return (_CURRENT if unit == "A" else _FORCE).fullmatch(name) is not None
    if len(unit) < 2 and unit != "%":
        return bool(sign.strip()) and sign != "_" and is_unit(unit)
    if sign == "_" and is_word(unit):
        return False  # part of a name, as in u_volt
    return is_unit(unit) and unit not in {"in", "none", "index", "sample", "samples", "points"}

"""What a cell of a text file can be: a number, one with a unit or a key, a time stamp, nothing."""

from __future__ import annotations

import functools
import re
from typing import Literal

Kind = Literal["number", "quantity", "stamp", "pair", "text"]

MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "--", "inf", "+inf", "-inf"})
_MORE_MISSING = re.compile(r"[+-]?(?:1\.#(?:IND|INF|QNAN)\w*|-?nan\(.*\))", re.IGNORECASE)
_EXPONENT = r"(?:[eEdD][+-]?\d+)?"
_NUMBER = {
    ".": rf"(?:\d+\.?\d*|\.\d+){_EXPONENT}",
    ",": rf"(?:\d+(?:,\d+)?|,\d+){_EXPONENT}",
}
# Signs between thousands that are no decimal sign: apostrophes and the narrow and wide spaces.
_QUIET = "'\N{RIGHT SINGLE QUOTATION MARK}\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}"
_QUIET += "\N{THIN SPACE} "
_UNIT = (
    r"[A-Za-z%\N{DEGREE SIGN}\N{MICRO SIGN}\N{GREEK SMALL LETTER MU}\N{OHM SIGN}"
    r"\N{GREEK CAPITAL LETTER OMEGA}][^\s\d,;:=]{0,7}(?:/[^\s,;:=]{1,6}|\^?-?\d)?"
)
_CLOCK = r"\d{1,2}:\d{2}(?::\d{2})?(?:[.,:]\d+)?(?:\s*[AaPp]\.?[Mm]\.?)?"
_DATE = (
    r"(?:\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{2,4}|\d{1,2}-[A-Za-z]{3}-\d{4})"
)
_ZONE = r"\s*(?:Z|UTC|[+-]\d{2}:?\d{2})?"
STAMP = re.compile(rf"(?:{_DATE}(?:[T\s_]+{_CLOCK}{_ZONE})?|{_CLOCK}{_ZONE})", re.ASCII)
_KEY = r"[A-Za-z_][\w .()\[\]/-]{0,30}"


@functools.cache
def number_pattern(decimal: str) -> re.Pattern[str]:
    """Give the pattern of a plain number with this decimal sign."""
    return re.compile(rf"[+-]?{_NUMBER[decimal]}", re.ASCII)


@functools.cache
def thousands_pattern(decimal: str) -> re.Pattern[str]:
    """Give the pattern of a number whose thousands are set apart; its group is the sign."""
    other = "," if decimal == "." else r"\."
    fraction = r"\." if decimal == "." else ","
    return re.compile(
        rf"[+-]?[1-9]\d{{0,2}}(?:([{other}{_QUIET}])\d{{2,3}})(?:\1\d{{2,3}})*(?<=\d{{3}})"
        rf"(?:{fraction}\d*)?{_EXPONENT}",
        re.ASCII,
    )


@functools.cache
def quantity_pattern(decimal: str) -> re.Pattern[str]:
    """Give the pattern of a number with its unit: groups 1 and 2."""
    return re.compile(rf"([+-]?{_NUMBER[decimal]})\s*({_UNIT})")


@functools.cache
def pair_pattern(decimal: str) -> re.Pattern[str]:
    """Give the pattern of ``key: number``, with a unit or none: groups 1, 2 and 3."""
    return re.compile(rf'"?({_KEY}?)"?\s*[:=]\s*([+-]?{_NUMBER[decimal]})\s*({_UNIT})?')


def is_missing(cell: str) -> bool:
    """Tell whether a cell says that there is no value."""
    return cell.casefold() in MISSING or _MORE_MISSING.fullmatch(cell) is not None


def kind_of(cell: str, decimal: str) -> Kind:
    """Tell what a cell is.

    Parameters
    ----------
    cell
        Its text.
    decimal
        Decimal sign of the file, ``.`` or ``,``.

    Examples
    --------
    >>> [kind_of(each, ".") for each in ("1e3", "1'006.5", "5 mV", "12:00:01", "u: 5", "off")]
    ['number', 'number', 'quantity', 'stamp', 'pair', 'text']
    """
    if number_pattern(decimal).fullmatch(cell) or thousands_pattern(decimal).fullmatch(cell):
        return "number"
    if STAMP.fullmatch(cell):
        return "stamp"
    if quantity_pattern(decimal).fullmatch(cell):
        return "quantity"
    return "pair" if pair_pattern(decimal).fullmatch(cell) else "text"

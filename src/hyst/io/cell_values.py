"""Numbers of a column of cells that are not all plain numbers."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.io.cells import (
    Kind,
    is_missing,
    kind_of,
    number_pattern,
    pair_pattern,
    quantity_pattern,
    thousands_pattern,
)
from hyst.io.stamps import seconds_of_stamps
from hyst.io.table import Flaw

_SAMPLED = 200
_FEWEST_SURE = 3
_FORTRAN = re.compile(r"(?<=[\d.])[dD](?=[+-]?\d)")


@dataclass(frozen=True, eq=False)
class ColumnOfCells:
    """What a column of cells says.

    Parameters
    ----------
    values
        Shape (N,); NaN where there is no number.
    flaw
        The first cell that is not a finite number, if there is one.
    unit
        Unit that all cells carry; empty if none do.
    name
        Key that all cells carry; empty if none do.
    notes
        How the cells were read, where there was something to find out.
    stamps
        Whether the cells are dates or times of day, which were turned into seconds.
    """

    values: NDArray[np.float64]
    flaw: Flaw | None
    unit: str = ""
    name: str = ""
    notes: tuple[str, ...] = ()
    stamps: bool = False


def read_cells(cells: Sequence[str], decimal: str) -> ColumnOfCells:
    """Read a column: plain numbers, with thousands set apart, a unit or a key, or time stamps.

    Parameters
    ----------
    cells
        As they stand in the file.
    decimal
        The decimal sign of the file, ``.`` or ``,``.

    Returns
    -------
    ColumnOfCells

    Examples
    --------
    >>> found = read_cells(["990,5", "1.006,25"], ",")
    >>> found.values.tolist(), read_cells(["5 mV", "7 mV"], ".").unit
    ([990.5, 1006.25], 'mV')
    """
    plain = np.array([_plain(cell, decimal) for cell in cells])
    if np.isfinite(plain).all():
        return ColumnOfCells(plain, None)
    kind = _usual_kind(cells, decimal)
    if kind == "stamp":
        stamps = seconds_of_stamps(cells)
        return ColumnOfCells(stamps.seconds, stamps.flaw, "s", "", stamps.notes, True)
    if kind in ("quantity", "pair"):
        return _with_unit(cells, decimal, kind)
    other = "," if decimal == "." else "."
    if _is_written_with(cells, other, decimal):
        values = np.array([_plain(cell, other) for cell in cells])
        note = f"read with the decimal sign {other!r}, where others in the file have {decimal!r}"
        return ColumnOfCells(values, _first_flaw(values, cells), notes=(note,))
    return _with_thousands(plain, cells, decimal)


def _is_written_with(cells: Sequence[str], sign: str, decimal: str) -> bool:
    """Tell whether a whole column has another decimal sign, which cannot be one of thousands."""
    written = [cell for cell in cells if not is_missing(cell)]
    if any(decimal in cell for cell in written):
        return False
    number, thousands = number_pattern(sign), thousands_pattern(decimal)
    if not all(number.fullmatch(cell) for cell in written):
        return False
    signed = [cell for cell in written if sign in cell]
    sure = sum(thousands.fullmatch(cell) is None for cell in signed)
    return sure >= _FEWEST_SURE and 2 * sure > len(signed)


def _plain(cell: str, decimal: str) -> float:
    if decimal == ",":
        if "." in cell:
            return math.nan
        cell = cell.replace(",", ".")
    # float() also takes 1_000 and digits of other scripts, which no instrument writes.
    if "_" in cell or not cell.isascii():
        return math.nan
    try:
        return float(cell)
    except ValueError:
        pass
    try:
        return float(_FORTRAN.sub("e", cell))
    except ValueError:
        return math.nan


def _usual_kind(cells: Sequence[str], decimal: str) -> Kind:
    """Give the kind most of the cells are of, judged by some of them from all over the column."""
    stride = max(1, len(cells) // _SAMPLED)
    seen = Counter(kind_of(cell, decimal) for cell in cells[::stride] if not is_missing(cell))
    return seen.most_common(1)[0][0] if seen else "text"


def _first_flaw(values: NDArray[np.float64], cells: Sequence[str], why: str = "") -> Flaw | None:
    finite = np.isfinite(values)
    if finite.all():
        return None
    row = int(np.argmin(finite))
    return Flaw(row, cells[row], why)


def _with_thousands(
    plain: NDArray[np.float64], cells: Sequence[str], decimal: str
) -> ColumnOfCells:
    """Read numbers with their thousands set apart, where the column leaves no doubt of it."""
    pattern = thousands_pattern(decimal)
    odd = np.flatnonzero(~np.isfinite(plain)).tolist()
    found = {row: pattern.fullmatch(cells[row]) for row in odd}
    signs = Counter(match[1] for match in found.values() if match)
    other = "," if decimal == "." else "."
    doubtful = _first_in_doubt(cells, found, decimal, other)
    if len(signs) != 1 or doubtful is not None:
        return ColumnOfCells(plain, _flaw_of_signs(plain, cells, doubtful, decimal))
    sign = next(iter(signs))
    values = plain.copy()
    for row, match in found.items():
        if match:
            values[row] = _plain(cells[row].replace(sign, ""), decimal)
    shown = "a blank" if sign.isspace() else repr(sign)
    first = next(row for row, match in found.items() if match)
    note = f"read {cells[first]} as {values[first]:.12g}: {shown} stands between thousands"
    return ColumnOfCells(values, _first_flaw(values, cells), notes=(note,))


def _first_in_doubt(
    cells: Sequence[str],
    found: dict[int, re.Match[str] | None],
    decimal: str,
    other: str,
) -> int | None:
    """Give the first cell with the other decimal sign, unless the column shows what that means.

    It shows that where a number has both signs, or the sign twice, and all others with it are as
    such numbers are.
    """
    with_sign = [row for row in found if other in cells[row] and not is_missing(cells[row])]
    if not with_sign:
        return None
    shown = any(
        found[row] and (decimal in cells[row] or cells[row].count(other) > 1) for row in with_sign
    )
    odd = [row for row in with_sign if not found[row] and _is_number_otherwise(cells[row], other)]
    if shown and not odd:
        return None
    candidates = odd or [row for row in with_sign if _is_number_otherwise(cells[row], other)]
    return int(candidates[0]) if candidates else None


def _is_number_otherwise(cell: str, other: str) -> bool:
    return number_pattern(other).fullmatch(cell) is not None


def _flaw_of_signs(
    values: NDArray[np.float64], cells: Sequence[str], doubtful: int | None, decimal: str
) -> Flaw | None:
    first = _first_flaw(values, cells)
    if doubtful is None:
        return first
    cell = cells[doubtful]
    other = "," if decimal == "." else "."
    bare = cell.replace(other, "")
    may_be_thousands = thousands_pattern(decimal).fullmatch(cell) is not None
    meant = cell.replace(",", ".")
    if may_be_thousands:
        why = f"which may be {meant} or {bare} where the file has the decimal sign {decimal!r}"
    else:
        why = f"while the decimal sign of the file is {decimal!r}"
    return Flaw(doubtful, cell, f"{why}; write all numbers with one decimal sign")


def _with_unit(cells: Sequence[str], decimal: str, kind: Kind) -> ColumnOfCells:
    """Read numbers that carry a unit or a key, which must be the same in all of them."""
    values = np.full(len(cells), math.nan)
    pattern = pair_pattern(decimal) if kind == "pair" else quantity_pattern(decimal)
    name = unit = None
    for row, cell in enumerate(cells):
        match = pattern.fullmatch(cell)
        if match is None:
            values[row] = _plain(cell, decimal)
            continue
        key, number, own = match.groups() if kind == "pair" else ("", *match.groups())
        own = own or ""
        name, unit = key if name is None else name, own if unit is None else unit
        if (key, own) != (name, unit):
            why = f"while others before it have {(name + ' ' + unit).strip()!r}"
            return ColumnOfCells(np.full(len(cells), math.nan), Flaw(row, cell, why))
        values[row] = _plain(number, decimal)
    return ColumnOfCells(values, _first_flaw(values, cells), unit or "", (name or "").strip())

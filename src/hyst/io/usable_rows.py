"""Which rows of a table hold measurements, and how many others may be left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.cells import is_missing
from hyst.io.codes_in_rows import (
    Codes,
    codes_of_both,
    refuse_codes,
    rows_counted,
    told_of_codes,
)
from hyst.io.columns import refuse_flaws
from hyst.io.known_units import is_unit
from hyst.io.table import Table

LONGEST_GAP = 5
FEWEST_SAMPLES = 3
REMEDY = ", or leave such rows out with the option repair"
# Repair leaves out single faults; what lacks more than this is another record than the one wanted.
_LARGEST_SHARE = 0.05
_ALWAYS_ALLOWED = 3


def most_left_out(rows: int) -> int:
    """Give how many of so many rows repair may leave out or fill in."""
    return max(_ALWAYS_ALLOWED, int(_LARGEST_SHARE * rows))


def usable_rows(
    table: Table, chosen: list[int], repair: bool, longest_gap: int
) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    """Give the rows to take: all of them, or with ``repair`` those with a value in each column.

    Parameters
    ----------
    table
        Where to look.
    chosen
        Columns of input and output, and that of time if there is one.
    repair
        Whether rows may be left out.
    longest_gap
        How many of them one after the other between others.

    Returns
    -------
    tuple
        Indices of rows, and what was left out, one sentence each.

    Raises
    ------
    InputError
        If a value is missing or none and ``repair`` is not set, or too many are.
    """
    finite = [np.isfinite(table.columns[k]) for k in chosen]
    good = np.logical_and.reduce(finite)
    codes = codes_of_both(table, chosen[0], chosen[1], np.flatnonzero(good))
    for code in (*codes[0], *codes[1]):
        good[code.samples] = False
    rows = np.flatnonzero(good)
    missing = good.size - rows.size
    if not missing:
        return require_samples(table, rows), ()
    allowed = missing <= most_left_out(good.size)
    refuse_row_of_units(table, chosen)
    for k, usable in zip(chosen, finite, strict=True):
        flaw = table.flaws[k]
        if not (repair and usable.any() and not (flaw and flaw.why)):
            possible = allowed and bool(usable.any())
            refuse_flaws(table, k, _remedy(possible, missing, good.size))
    if not repair:
        for k, found in zip(chosen, codes, strict=False):
            refuse_codes(table, k, found, REMEDY if allowed else "")
    if not allowed:
        raise InputError(
            f"{table.source}: {missing} of {good.size} rows hold no value in one of the columns, "
            f"and repair leaves out {most_left_out(good.size)} at most; "
            "give a file that is complete"
        )
    _refuse_long_gap(table, rows, longest_gap)
    return require_samples(table, rows), _told(table, chosen, codes, np.logical_and.reduce(finite))


def refuse_row_of_units(table: Table, chosen: list[int]) -> None:
    """Refuse a first row with a unit in it: leaving it out would leave out the unit of the time.

    Parameters
    ----------
    table, chosen
        As of ``usable_rows``.

    Raises
    ------
    InputError
        If so.
    """
    for k in chosen:
        flaw = table.flaws[k]
        if flaw and flaw.row == 0 and is_unit(flaw.text) and not is_missing(flaw.text):
            raise InputError(
                f"{table.source}: {table.names[k]!r} is {flaw.text!r} at {table.place(0)}, a unit "
                "in a row where hyst does not know the others; make that row a comment with #, "
                "and give time_unit or a rate"
            )


def require_samples(table: Table, rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Give rows of a table that are enough for a record, or refuse them.

    Parameters
    ----------
    table
        Where they are.
    rows
        Their indices.

    Raises
    ------
    InputError
        If there are fewer than 3.
    """
    if rows.size < FEWEST_SAMPLES:
        raise InputError(
            f"{table.source} has {rows.size} usable samples; give a record of at least "
            f"{FEWEST_SAMPLES}, with several rises and falls"
        )
    return rows


def _remedy(allowed: bool, missing: int, rows: int) -> str:
    if allowed:
        return f"correct it{REMEDY}"
    return (
        f"{missing} of {rows} rows lack a value, too many to leave out; give a file that "
        "is complete"
    )


def _refuse_long_gap(table: Table, rows: NDArray[np.intp], longest_gap: int) -> None:
    gaps = np.diff(rows) - 1
    if gaps.size and int(gaps.max()) > longest_gap:
        before = int(np.argmax(gaps))
        raise InputError(
            f"{table.source}: {int(gaps[before])} rows in a row hold no value after "
            f"{table.place(int(rows[before]))}, and repair bridges {longest_gap} at most "
            "(longest_gap); cut the record there"
        )


def _told(
    table: Table, chosen: list[int], codes: tuple[Codes, Codes], finite: NDArray[np.bool_]
) -> tuple[str, ...]:
    notes = []
    dropped = int(finite.size - finite.sum())
    if dropped:
        notes.append(f"left out {rows_counted(dropped)} that held no number or no finite one")
    for k, found in zip(chosen, codes, strict=False):
        notes += told_of_codes(table, k, found)
    return tuple(notes)

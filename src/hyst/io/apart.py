"""Read input and output that have stamps, rows or files of their own."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.codes_in_rows import codes_of_column, refuse_codes, told_of_codes
from hyst.io.columns import find_column, notes_about, refuse_doubts, refuse_flaws, shorten
from hyst.io.formats import choose_table, read_tables
from hyst.io.own_times import OneRaster, Stamped, on_one_raster
from hyst.io.table import Table
from hyst.io.time_axis import TOLERANCE, first_step_back, worst_gap
from hyst.io.unit_of_stamps import unit_of_stamps
from hyst.io.usable_rows import FEWEST_SAMPLES, REMEDY
from hyst.signals import Record

# How a cell without a value is written.
_NOTHING = frozenset({"", "nan", "na", "n/a", "null", "none", "-"})

Column = int | str


@dataclass(frozen=True)
class Apart:
    """Where two signals are to be found that do not share their rows.

    Parameters
    ----------
    input, output
        Their columns.
    input_time, output_time
        Columns of their stamps; None if there are none.
    rate
        Samples per second of both, where there are no stamps.
    time_unit
        Unit of the stamps; None for what the header says.
    repair
        Whether values that are no numbers are left out.
    resample
        Whether different stamps are brought to one raster.
    hold_input
        Whether the input keeps its value until its next stamp.
    table, format
        As for ``read_record``.
    """

    input: Column
    output: Column
    input_time: Column | None
    output_time: Column | None
    rate: float | None
    time_unit: str | None
    repair: bool
    resample: bool
    hold_input: bool = False
    table: int | None = None
    format: str | None = None


def read_apart(
    path: str | os.PathLike[str],
    output_file: str | os.PathLike[str] | None,
    where: Apart,
    max_samples: int,
) -> Record:
    """Read two signals, each with its own stamps, as one record.

    Parameters
    ----------
    path
        The file of the input.
    output_file
        The file of the output; None for the same.
    where
        The columns.
    max_samples
        Most numbers to read of each file.

    Returns
    -------
    Record
        On the stamps they share, or on one raster; the notes say what that costs.

    Raises
    ------
    InputError
        If a file or column cannot be read, stamps do not increase, or they differ and ``resample``
        is not asked for.
    """
    other = path if output_file is None else output_file
    u = _signal(path, where.input, where.input_time, where, max_samples)
    y = _signal(other, where.output, where.output_time, where, max_samples)
    source = str(path) if output_file is None else f"{path} and {other}"
    both = _together(u, y, source, where)
    return Record(
        both.u,
        both.y,
        both.dt,
        input_name=u.name,
        output_name=y.name,
        input_unit=u.unit,
        output_unit=y.unit,
        notes=(*u.notes, *(each for each in y.notes if each not in u.notes), *both.notes),
    )


def _signal(
    path: str | os.PathLike[str], column: Column, time: Column | None, where: Apart, most: int
) -> Stamped:
    wanted = [column] if time is None else [column, time]
    tables = read_tables(
        path, columns=wanted, max_samples=most, format=where.format, repair=where.repair
    )
    if where.table is not None or len(tables) > 1:
        tables = (choose_table(tables, where.table),)
    (table,) = tables
    found = find_column(table, column)
    refuse_doubts(table, found)
    if where.rate is not None or time is None:
        refuse_flaws(table, found, "correct it")
        rows = np.arange(table.columns[found].size)
        refuse_codes(table, found, codes_of_column(table, found, rows), "")
        return _named(table, found, rows / (where.rate or 1.0), rows, notes_about(table, [found]))
    clock = find_column(table, time)
    if clock == found:
        raise InputError(f"{table.source}: {table.headers[found]!r} cannot be its own time")
    return _stamped(table, found, clock, where)


def _stamped(table: Table, column: int, clock: int, where: Apart) -> Stamped:
    values, time = table.columns[column], table.columns[clock]
    if values.size != time.size:
        raise InputError(
            f"{table.source}: {table.names[column]!r} has {values.size} values and "
            f"{table.names[clock]!r} {time.size}; choose the stamps that belong to it"
        )
    rows, left_out = _rows_with_both(table, column, clock, where.repair)
    seconds, told = unit_of_stamps(table, clock, time[rows], where.time_unit)
    back = first_step_back(time[rows])
    if back is not None:
        raise InputError(
            f"{table.source}: the time {table.names[clock]!r} of {table.names[column]!r} does not "
            f"increase at {table.place(int(rows[back]))}; correct the stamps"
        )
    notes = (*notes_about(table, [column, clock]), *told, *left_out)
    return _named(table, column, time[rows] * seconds, rows, notes)


def _named(
    table: Table,
    column: int,
    time: NDArray[np.float64],
    rows: NDArray[np.intp],
    notes: tuple[str, ...],
) -> Stamped:
    values = table.columns[column][rows]
    return Stamped(table.names[column], table.units[column], time, values, notes)


def _rows_with_both(
    table: Table, column: int, clock: int, repair: bool
) -> tuple[NDArray[np.intp], list[str]]:
    """Give the rows with a value and a stamp; empty cells are the other signal's rows."""
    left_out = []
    for k in (column, clock):
        flaw = table.flaws[k]
        if flaw is None or flaw.text.strip().casefold() in _NOTHING:
            continue
        if not repair or flaw.why:
            refuse_flaws(table, k, f"correct it{REMEDY}")
        left_out.append(
            f"left out rows where {table.names[k]!r} is no number, as {shorten(flaw.text)} at "
            f"{table.place(flaw.row)}"
        )
    rows = np.flatnonzero(np.isfinite(table.columns[column]) & np.isfinite(table.columns[clock]))
    codes = codes_of_column(table, column, rows)
    if not repair:
        refuse_codes(table, column, codes, REMEDY)
    left_out += told_of_codes(table, column, codes)
    for code in codes:
        rows = np.setdiff1d(rows, code.samples)
    if rows.size < FEWEST_SAMPLES:
        raise InputError(
            f"{table.source}: {table.names[column]!r} has {rows.size} values with a stamp; give at "
            f"least {FEWEST_SAMPLES}"
        )
    return rows, left_out


def _together(u: Stamped, y: Stamped, source: str, where: Apart) -> OneRaster:
    """Bring the signals to one raster, if need be."""
    if where.resample:
        return on_one_raster(u, y, source, hold_input=where.hold_input)
    if u.time.size != y.time.size:
        raise InputError(
            f"{source}: {u.name!r} has {u.time.size} samples and {y.name!r} {y.time.size}; the "
            "option resample brings both to one raster, if they have stamps"
        )
    apart = float(np.abs(u.time - y.time).max())
    if apart > TOLERANCE * _step(u.time):
        raise InputError(
            f"{source}: the stamps of {u.name!r} and {y.name!r} are up to {apart:.6g} s apart; the "
            "option resample brings both to one raster"
        )
    gap = worst_gap(y.time)
    if not gap.even:
        raise InputError(
            f"{source}: time is uneven, the worst gap is {gap.size:.6g} s and the median gap "
            f"{gap.median:.6g} s (tolerance {TOLERANCE:.0%}); bring it to even steps with the "
            "option resample"
        )
    dt = float(f"{(y.time[-1] - y.time[0]) / (y.time.size - 1):.12g}")
    return OneRaster(dt, u.values, y.values, ())


def _step(time: NDArray[np.float64]) -> float:
    return float(np.median(np.diff(time)))

"""The unit of a column of stamps: what was asked for, its header or its name say; never a guess."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.header import is_time, unit_of_time_in_name
from hyst.io.table import Table
from hyst.io.units_of_time import seconds_per_unit

_MANY_SECONDS = 1e11
_UNITS = "s, ms, us, ns, min, h or days"
_SECONDS_A_DAY = 86400.0
# Days since 1900, as spreadsheets count them, and since the year 0, as MATLAB does: 1954 to 2064.
_DAYS = ((20e3, 60e3), (714e3, 754e3))
_LONGEST_STEP_OF_DAYS = 1e-4
_COUNTERS = re.compile(
    r"(?:samples?|points?|pts?|idx|index|scans?|rows?|n|nr|#)"
    r"(?:[\s_.-]*(?:no|nr|num|number|index|idx|count|id|#)\.?)?",
    re.IGNORECASE,
)


def require_time_unit(unit: str | None) -> None:
    """Refuse a unit of time that a user gave and hyst does not know.

    Raises
    ------
    InputError
        If so.
    """
    if unit is not None and seconds_per_unit(unit) is None:
        raise InputError(f"time_unit is {unit!r}; give {_UNITS}")


def unit_of_stamps(
    table: Table, column: int, stamps: NDArray[np.float64], time_unit: str | None
) -> tuple[float, tuple[str, ...]]:
    """Give the seconds in the unit of a column of stamps, and what is to be told about it.

    Parameters
    ----------
    table, column
        Where the stamps are.
    stamps
        Those that are used, finite.
    time_unit
        What the user says; None for what the file says.

    Raises
    ------
    InputError
        If the unit is unknown, contradicted in the file, or missing where the stamps are no
        seconds.
    """
    header, unit = table.headers[column], table.units[column]
    told: tuple[str, ...] = ()
    if time_unit is None:
        if column in table.doubts:
            raise InputError(f"{table.source}: {header!r}: {table.doubts[column]}; give time_unit")
        unit = unit or unit_of_time_in_name(table.names[column])
        _refuse_unlikely_seconds(table, header, unit, stamps)
    elif unit and seconds_per_unit(unit) not in (None, seconds_per_unit(time_unit)):
        told = (f"{header!r} was taken as {time_unit}, as time_unit says",)
    seconds = seconds_per_unit(unit if time_unit is None else time_unit)
    if seconds is None:
        raise InputError(
            f"{table.source}: the time column {header!r} has the unit {unit!r}, which is no unit "
            f"of time hyst knows; give time_unit {_UNITS}"
        )
    return seconds, told


def _refuse_unlikely_seconds(
    table: Table, header: str, unit: str, stamps: NDArray[np.float64]
) -> None:
    """Refuse stamps without a unit that cannot be seconds, and names that may be two units."""
    if unit:
        return
    if header.strip().casefold().endswith("_m") and is_time(header.strip()[:-2]):
        raise InputError(
            f"{table.source}: {header!r} may be minutes or something else that is called m; give "
            "time_unit"
        )
    if _MANY_SECONDS < np.abs(stamps).max(initial=0.0) < 1e20:
        raise InputError(
            f"{table.source}: {header!r} has no unit and reads {stamps[0]:.12g}, which are no "
            "seconds, but may be ms or us since 1970 or ns of a clock; give time_unit"
        )
    _refuse_days(table, header, stamps)
    _refuse_counts(table, header, stamps)


def _refuse_days(table: Table, header: str, stamps: NDArray[np.float64]) -> None:
    """Refuse dates as spreadsheets and MATLAB number them: whole steps only if they are days."""
    if stamps.size < 2 or not any(low <= stamps[0] <= high for low, high in _DAYS):
        return
    step = abs(float(stamps[-1] - stamps[0])) / (stamps.size - 1)
    if 0.0 < step < _LONGEST_STEP_OF_DAYS and not _is_short(step):
        raise InputError(
            f"{table.source}: {header!r} has no unit and reads {stamps[0]:.12g} with steps of "
            f"{step:.3g}, which may be seconds, or days as spreadsheets and MATLAB count them, "
            f"{step * _SECONDS_A_DAY:.6g} s apart; give time_unit"
        )


def _is_short(step: float) -> bool:
    """Tell whether two digits write a step, as those of samplers."""
    return abs(float(f"{step:.1e}") - step) <= 1e-3 * step


def _refuse_counts(table: Table, header: str, stamps: NDArray[np.float64]) -> None:
    """Refuse the numbers of the samples as their time."""
    if _COUNTERS.fullmatch(header.strip()) and np.array_equal(
        np.diff(stamps), np.ones(stamps.size - 1)
    ):
        raise InputError(
            f"{table.source}: {header!r} counts samples and is no time; choose the column of the "
            "time, or give a rate instead (or time_unit s if the samples are 1 s apart)"
        )

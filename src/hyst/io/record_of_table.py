"""From the columns of a table to a record, or a clear refusal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive, whole_number
from hyst.errors import InputError
from hyst.io.columns import find_column
from hyst.io.even_time import Samples, on_even_steps
from hyst.io.header import is_time, unit_of_time_in_name
from hyst.io.own_times import refuse_own_times
from hyst.io.table import Table
from hyst.io.units_of_time import seconds_per_unit
from hyst.io.usable_rows import LONGEST_GAP, usable_rows
from hyst.signals import Record, reversals, suggest_dead_band

_FEWEST_REVERSALS = 2
_WHOLE_LOOP = 0.5
_MANY_SECONDS = 1e11


@dataclass(frozen=True)
class Wanted:
    """What to take from a table.

    Parameters
    ----------
    input, output, time, rate, time_unit, repair, dead_band, longest_gap
        As in ``read_record``.

    Raises
    ------
    InputError
        If they contradict each other, or one of them is unusable.
    """

    input: int | str
    output: int | str
    time: int | str | None = None
    rate: float | None = None
    time_unit: str | None = None
    repair: bool = False
    dead_band: float | None = None
    longest_gap: int = LONGEST_GAP

    def __post_init__(self) -> None:
        if self.rate is not None and self.time is not None:
            raise InputError("both of rate and time given; give one, a rate in Hz or a time column")
        unit = self.time_unit
        if unit is not None and (self.time is None or seconds_per_unit(unit) is None):
            raise InputError(
                f"time_unit is {unit!r}; give s, ms, us, ns, min or h, and only with a time column"
            )
        if self.rate is not None:
            as_positive(self.rate, "rate", "the samples per second")
        whole_number(self.longest_gap, "longest_gap", 0, 10**9)

    def columns(self) -> Mapping[str, int | str | None]:
        """Give the columns by their roles."""
        return {"input": self.input, "output": self.output, "time": self.time}

    def used(self) -> list[int | str]:
        """Give the columns that will be used."""
        return [each for each in self.columns().values() if each is not None]


def record_of_table(
    table: Table, wanted: Wanted, read: Callable[[Table, int], NDArray[np.float64]]
) -> Record:
    """Make a record of two columns of a table and the time of its rows.

    Parameters
    ----------
    table
        What was read.
    wanted
        Which columns, and how.
    read
        Gives a column of the table, read already or not.

    Returns
    -------
    Record
        Its notes tell what was found out, left out and repaired.

    Raises
    ------
    InputError
        See ``read_record``.
    """
    chosen = choose_columns(table, wanted.columns())
    for k in chosen[:2]:
        if k in table.doubts:
            raise InputError(f"{table.source}: {table.names[k]!r}: {table.doubts[k]}; correct one")
    if wanted.time is not None:
        roles = {"input": chosen[0], "output": chosen[1]}
        refuse_own_times(table, roles, chosen[2], lambda column: read(table, column))
    rows, left_out = usable_rows(table, chosen, wanted.repair, wanted.longest_gap)
    signals = [table.columns[k][rows] for k in chosen[:2]]
    samples, told = _samples(table, chosen, rows, signals, wanted)
    even = on_even_steps(samples, wanted.repair, wanted.longest_gap)
    u, y = even.signals
    of_columns = [
        f"{table.names[k]!r}: {note}" for k in chosen for note in table.notes_of_columns.get(k, ())
    ]
    record = Record(
        u,
        y,
        even.dt,
        input_name=table.names[chosen[0]],
        output_name=table.names[chosen[1]],
        input_unit=table.units[chosen[0]],
        output_unit=table.units[chosen[1]],
        notes=(*table.notes, *of_columns, *told, *left_out, *even.notes),
    )
    refuse_unusable(table.source, record, wanted.dead_band)
    return record


def choose_columns(table: Table, wanted: Mapping[str, int | str | None]) -> list[int]:
    """Find the wanted columns, which must be different ones of one length.

    Parameters
    ----------
    table
        Where to look.
    wanted
        Columns by their roles; None where there is none.

    Returns
    -------
    list of int
        Their indices, in the order of the roles.

    Raises
    ------
    InputError
        If one is missing, two are the same, or their lengths differ.
    """
    roles: dict[int, str] = {}
    for role, column in wanted.items():
        if column is None:
            continue
        found = find_column(table, column)
        if found in roles:
            raise InputError(
                f"{table.source}: {roles[found]} and {role} are the same column, "
                f"{table.headers[found]!r}; choose two different ones"
            )
        roles[found] = role
    sizes = [table.columns[k].size for k in roles]
    if len(set(sizes)) > 1:
        pairs = " and ".join(f"{table.names[k]!r} {n}" for k, n in zip(roles, sizes, strict=True))
        raise InputError(
            f"{table.source}: the columns have different numbers of values, {pairs}; "
            "choose columns of one length"
        )
    return list(roles)


def _samples(
    table: Table,
    chosen: list[int],
    rows: NDArray[np.intp],
    signals: list[NDArray[np.float64]],
    wanted: Wanted,
) -> tuple[Samples, tuple[str, ...]]:
    """Give the samples with their time, and what is to be told about it."""
    if wanted.time is not None:
        stamps, seconds, told = _stamps(table, chosen, rows, wanted.time_unit)
        return Samples(table, rows, stamps, seconds, signals, rate_given=False), told
    told = ()
    if wanted.rate is not None:
        period = 1.0 / wanted.rate
        if table.step is not None and abs(table.step - period) > 1e-3 * period:
            told = (
                f"the rate given is {wanted.rate:.9g} Hz, the file itself states "
                f"{1.0 / table.step:.9g} Hz; the one given was used",
            )
    elif table.step is None:
        raise InputError(
            f"neither of rate and time given, and {table.source} states no rate; give one, a rate "
            "in Hz or a time column"
        )
    else:
        period = table.step
        told = (f"the file states {period:.9g} s between samples, which was used",)
    return Samples(table, rows, rows.astype(np.float64), period, signals, rate_given=True), told


def _stamps(
    table: Table, chosen: list[int], rows: NDArray[np.intp], time_unit: str | None
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    """Give the time column as it stands and the seconds in its unit."""
    column = chosen[2]
    header, unit = table.headers[column], table.units[column]
    in_name = "" if unit else unit_of_time_in_name(table.names[column])
    stamps = table.columns[column][rows]
    told: tuple[str, ...] = ()
    if time_unit is None:
        if column in table.doubts:
            raise InputError(f"{table.source}: {header!r}: {table.doubts[column]}; give time_unit")
        unit = unit or in_name
        _refuse_unlikely_seconds(table, header, unit, stamps)
    elif unit and seconds_per_unit(unit) not in (None, seconds_per_unit(time_unit)):
        told = (f"{header!r} was taken as {time_unit}, as time_unit says",)
    seconds = seconds_per_unit(unit if time_unit is None else time_unit)
    if seconds is None:
        raise InputError(
            f"{table.source}: the time column {header!r} has the unit {unit!r}, which is no unit "
            "of time hyst knows; give time_unit s, ms, us, ns, min or h"
        )
    return stamps, seconds, told


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
    if np.abs(stamps).max() > _MANY_SECONDS and np.abs(stamps).max() < 1e20:
        raise InputError(
            f"{table.source}: {header!r} has no unit and reads {stamps[0]:.12g}, which are no "
            "seconds, but may be ms or us since 1970 or ns of a clock; give time_unit"
        )


def refuse_unusable(source: str, record: Record, dead_band: float | None) -> None:
    """Refuse signals that stand still, and an input without two turns or one whole loop.

    Parameters
    ----------
    source
        Name of the file, for messages.
    record
        What was read.
    dead_band
        As in ``read_record``.

    Raises
    ------
    InputError
        If so.
    """
    for name, signal, role in (
        (record.input_name, record.u, "input"),
        (record.output_name, record.y, "output"),
    ):
        if signal.min() == signal.max():
            raise InputError(
                f"{source}: the {role} {name!r} is {signal[0]:.6g} throughout; "
                "choose a column that moves"
            )
    u = record.u
    threshold = suggest_dead_band(u) if dead_band is None else dead_band
    turns = reversals(u, threshold)
    if turns.size >= _FEWEST_REVERSALS:
        return
    if turns.size == 1:
        turn = float(u[turns[0]])
        there, back = abs(turn - float(u[0])), abs(float(u[-1]) - turn)
        if min(there, back) >= _WHOLE_LOOP * max(there, back):
            return
    raise InputError(
        f"{source}: the input {record.input_name!r} has {turns.size} reversals beyond its dead "
        f"band of {threshold:.3g}, and hysteresis needs at least {_FEWEST_REVERSALS}, or one rise "
        "and fall of about the same size; record whole cycles, or give a smaller dead_band"
    )

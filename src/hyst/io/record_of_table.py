"""From the columns of a table to a record, or a clear refusal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive, whole_number
from hyst.errors import InputError
from hyst.io.columns import find_column, notes_about, refuse_doubts
from hyst.io.even_time import Samples, on_even_steps
from hyst.io.own_times import refuse_own_times, refuse_rows_apart
from hyst.io.table import Table
from hyst.io.unit_of_stamps import require_time_unit, unit_of_stamps
from hyst.io.usable_rows import LONGEST_GAP, usable_rows
from hyst.signals import Record, reversals, suggest_dead_band

_FEWEST_REVERSALS = 2
_WHOLE_LOOP = 0.5


@dataclass(frozen=True)
class Wanted:
    """What to take from a table.

    Parameters
    ----------
    input, output, time, rate, time_unit, repair, dead_band, longest_gap, one_way
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
    one_way: bool = False

    def __post_init__(self) -> None:
        if self.rate is not None and self.time is not None:
            raise InputError("both of rate and time given; give one, a rate in Hz or a time column")
        require_time_unit(self.time_unit)
        if self.time_unit is not None and self.time is None:
            raise InputError(f"time_unit is {self.time_unit!r}; give it only with a time column")
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
        refuse_doubts(table, k)
    refuse_rows_apart(table, chosen[:2])
    if wanted.time is not None:
        roles = {"input": chosen[0], "output": chosen[1]}
        refuse_own_times(table, roles, chosen[2], lambda column: read(table, column))
    rows, left_out = usable_rows(table, chosen, wanted.repair, wanted.longest_gap)
    signals = [table.columns[k][rows] for k in chosen[:2]]
    samples, told = _samples(table, chosen, rows, signals, wanted)
    even = on_even_steps(samples, wanted.repair, wanted.longest_gap)
    u, y = even.signals
    record = Record(
        u,
        y,
        even.dt,
        input_name=table.names[chosen[0]],
        output_name=table.names[chosen[1]],
        input_unit=table.units[chosen[0]],
        output_unit=table.units[chosen[1]],
        notes=(*notes_about(table, chosen), *told, *left_out, *even.notes),
    )
    refuse_unusable(table.source, record, wanted.dead_band, wanted.one_way)
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
        stamps = table.columns[chosen[2]][rows]
        seconds, told = unit_of_stamps(table, chosen[2], stamps, wanted.time_unit)
        return Samples(table, rows, stamps, seconds, signals, rate_given=False), told
    period, told = step_of_rows(table, wanted)
    return Samples(table, rows, rows.astype(np.float64), period, signals, rate_given=True), told


def step_of_rows(table: Table, wanted: Wanted) -> tuple[float, tuple[str, ...]]:
    """Give the seconds between rows without stamps, and what is to be told about them.

    Parameters
    ----------
    table
        It may state the step.
    wanted
        It may have the rate.

    Raises
    ------
    InputError
        If neither does.
    """
    told: tuple[str, ...] = ()
    if wanted.rate is not None:
        period = 1.0 / wanted.rate
        if table.step is not None and abs(table.step - period) > 1e-3 * period:
            told = (
                f"the rate given is {wanted.rate:.9g} Hz, the file itself states "
                f"{1.0 / table.step:.9g} Hz; the one given was used",
            )
        return period, told
    if table.step is None:
        raise InputError(
            f"neither of rate and time given, and {table.source} states no rate that is "
            "clear; give one, a rate in Hz or a time column"
        )
    return table.step, (f"the file states {table.step:.9g} s between samples, which was used",)


def refuse_unusable(
    source: str, record: Record, dead_band: float | None, one_way: bool = False
) -> None:
    """Refuse signals that stand still, and an input without two turns or one whole loop.

    Of an input that may go one way nothing is asked.

    Parameters
    ----------
    source
        Name of the file, for messages.
    record
        What was read.
    dead_band, one_way
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
        if one_way and role == "input":
            continue  # it may hold a level, too
        if signal.min() == signal.max():
            raise InputError(
                f"{source}: the {role} {name!r} is {signal[0]:.6g} throughout; "
                "choose a column that moves"
            )
    u = record.u
    if one_way:
        return
    if dead_band is None and reversals(u, float(np.ptp(u) / 4.0)).size >= _FEWEST_REVERSALS:
        return  # no dead band that is proposed is wider
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

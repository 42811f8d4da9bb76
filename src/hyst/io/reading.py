"""Read a record, or a single column, from a data file."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive
from hyst.errors import InputError
from hyst.io.apart import Apart, read_apart
from hyst.io.columns import find_column, refuse_flaws
from hyst.io.entries import MOST_SAMPLES
from hyst.io.formats import read_table
from hyst.io.own_times import refuse_own_times
from hyst.io.table import Table
from hyst.io.time_axis import TOLERANCE, first_step_back, resample, seconds_per_unit, worst_gap
from hyst.signals import Record, reversals, suggest_dead_band

_FEWEST_SAMPLES = 3
_FEWEST_REVERSALS = 2


@dataclass(frozen=True)
class _Samples:
    """Samples taken from a file: their rows there, and their time in units of so many seconds.

    The time is the rows themselves when the rate is given.
    """

    table: Table
    rows: NDArray[np.intp]
    time: NDArray[np.float64]
    seconds: float
    signals: list[NDArray[np.float64]]
    rate_given: bool

    def place(self, sample: int) -> str:
        return self.table.place(int(self.rows[sample]))

    def step(self, gap: float) -> float:
        """Turn a gap into seconds; differences of stamps hold 12 digits, and 0.01 is 0.01."""
        step = gap * self.seconds
        return step if self.rate_given else float(f"{step:.12g}")


def read_record(
    path: str | os.PathLike[str],
    input: int | str,
    output: int | str,
    *,
    time: int | str | None = None,
    rate: float | None = None,
    time_unit: str | None = None,
    repair: bool = False,
    dead_band: float | None = None,
    resample: bool = False,
    hold_input: bool = False,
    input_time: int | str | None = None,
    output_time: int | str | None = None,
    output_file: str | os.PathLike[str] | None = None,
    max_samples: int = MOST_SAMPLES,
) -> Record:
    r"""Read input and output of a measurement from a data file.

    Every format of ``read_table`` will do. Columns are chosen by header, by name without unit,
    or by 0-based index (see ``find_column``).

    Parameters
    ----------
    path
        The file.
    input, output
        Columns of the input and of the output.
    time
        Column of the time stamps; their steps may differ from the median by at most 1 %, and the
        record's dt is their mean. Give either this or ``rate``.
    rate
        Samples per second, Hz, > 0.
    time_unit
        Unit of the time column, ``"s"``, ``"ms"``, ``"us"``, ...; by default what its header
        says, and seconds if it says nothing.
    repair
        Leave out rows where a value is missing or not a number, and interpolate linearly onto
        the median step where the time is uneven. What was done is in the record's notes.
    dead_band
        Swings of the input up to this size do not count as reversals, units of the input, >= 0;
        by default ``suggest_dead_band`` of the input.
    resample
        Bring two signals that were stamped apart to one raster, that of the slower one; the notes
        say what that costs. Rows where one of them has no value count for the other one only.
    hold_input
        In resampling, let the input keep each value until its next stamp, as a command to a
        converter does, instead of interpolating it.
    input_time, output_time
        Columns of the stamps of the input and of the output, where they are not ``time``.
    output_file
        The file of the output, if it is another one, as an oscilloscope writes a file a channel.
    max_samples
        Most numbers to read, as of ``read_table``.

    Returns
    -------
    Record
        The signals with their names and units; ``notes`` is empty unless something was repaired.

    Raises
    ------
    InputError
        If the file cannot be read (see ``read_table``); if not exactly one of ``time`` and
        ``rate`` is given, or one of them is unusable; if a column is missing, given twice,
        differs in length, or holds text, NaN or infinity (the first line is named); if time
        does not increase or is uneven (the worst gap is named); if fewer than 3 samples are
        left, a signal is constant, or the input has fewer than 2 reversals.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "loop.csv"
    >>> _ = path.write_text("t [ms],u [V],y [um]\n0,0,0\n5,1,3\n10,0,1\n15,1,3\n")
    >>> record = read_record(path, input="u", output="y", time="t")
    >>> record.dt, record.input_unit, record.y
    (0.005, 'V', array([0., 3., 1., 3.]))
    """
    if resample or output_file is not None or (input_time, output_time) != (None, None):
        clocks = [time if each is None else each for each in (input_time, output_time)]
        _refuse_clocks(rate, clocks, time_unit, resample)
        where = Apart(
            input, output, clocks[0], clocks[1], rate, time_unit, repair, resample, hold_input
        )
        record = read_apart(path, output_file, where, max_samples)
        _refuse_unusable(str(path), record, dead_band)
        return record
    if hold_input:
        raise InputError("hold_input says how to resample; give it with resample")
    period = _period(rate, time, time_unit)
    roles = {"input": input, "output": output, "time": time}
    wanted = [column for column in roles.values() if column is not None]
    table = read_table(path, columns=wanted, max_samples=max_samples)
    chosen = _choose(table, roles)
    if time is not None:
        _refuse_own_times(path, table, chosen)
    rows = _usable_rows(table, chosen, repair)
    if period is not None:
        stamps, seconds = rows.astype(np.float64), period
    else:
        stamps, seconds = _stamps(table, chosen[2], rows, time_unit)
    signals = [table.columns[k][rows] for k in chosen[:2]]
    samples = _Samples(table, rows, stamps, seconds, signals, rate_given=period is not None)
    dt, (u, y), notes = _on_even_steps(samples, repair)
    dropped = table.columns[chosen[0]].size - rows.size
    if dropped:
        notes = (f"left out {dropped} rows that held no number or no finite one", *notes)
    record = Record(
        u,
        y,
        dt,
        input_name=table.names[chosen[0]],
        output_name=table.names[chosen[1]],
        input_unit=table.units[chosen[0]],
        output_unit=table.units[chosen[1]],
        notes=notes,
    )
    _refuse_unusable(table.source, record, dead_band)
    return record


def read_column(
    path: str | os.PathLike[str], column: int | str
) -> tuple[NDArray[np.float64], str, str]:
    r"""Read a single column of a data file, for instance a wanted trajectory.

    Parameters
    ----------
    path
        The file, of any format of ``read_table``.
    column
        Header, name or 0-based index.

    Returns
    -------
    tuple
        Values (read-only, shape (N,), finite), name and unit.

    Raises
    ------
    InputError
        If the file cannot be read, the column is missing, or it holds text, NaN or infinity.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "wanted.txt"
    >>> _ = path.write_text("stroke (um)\n0\n1.5\n")
    >>> read_column(path, "stroke")
    (array([0. , 1.5]), 'stroke', 'um')
    """
    table = read_table(path, columns=[column])
    found = find_column(table, column)
    refuse_flaws(table, found, "correct it or take the row out")
    return table.columns[found], table.names[found], table.units[found]


def _period(rate: float | None, time: int | str | None, time_unit: str | None) -> float | None:
    """Give the time between two rows by the rate; None when a column tells."""
    if (rate is None) == (time is None):
        given = "neither" if rate is None else "both"
        raise InputError(f"{given} of rate and time given; give one, a rate in Hz or a time column")
    if time_unit is not None and (time is None or seconds_per_unit(time_unit) is None):
        raise InputError(
            f"time_unit is {time_unit!r}; give s, ms, us, ns, min or h, and only with a time column"
        )
    if rate is None:
        return None
    return 1.0 / as_positive(rate, "rate", "the samples per second")


def _choose(table: Table, wanted: dict[str, int | str | None]) -> list[int]:
    """Find the wanted columns, which must be different ones of one length."""
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


def _usable_rows(table: Table, chosen: list[int], repair: bool) -> NDArray[np.intp]:
    """Rows to take: all of them, or with ``repair`` those without a flaw."""
    finite = [np.isfinite(table.columns[k]) for k in chosen]
    for k, usable in zip(chosen, finite, strict=True):
        if not (repair and usable.any()):
            refuse_flaws(table, k, "correct it, or leave such rows out with the option repair")
    rows = np.flatnonzero(np.logical_and.reduce(finite))
    if rows.size < _FEWEST_SAMPLES:
        raise InputError(
            f"{table.source} has {rows.size} usable samples; give a record of at least "
            f"{_FEWEST_SAMPLES}, with several rises and falls"
        )
    return rows


def _stamps(
    table: Table, time: int, rows: NDArray[np.intp], time_unit: str | None
) -> tuple[NDArray[np.float64], float]:
    """Give the time column as it stands and the seconds in its unit."""
    unit = table.units[time] if time_unit is None else time_unit
    seconds = seconds_per_unit(unit)
    if seconds is None:
        raise InputError(
            f"{table.source}: the time column {table.headers[time]!r} has the unit {unit!r}, which "
            "is no unit of time hyst knows; give time_unit s, ms, us, ns, min or h"
        )
    return table.columns[time][rows], seconds


def _on_even_steps(
    samples: _Samples, repair: bool
) -> tuple[float, list[NDArray[np.float64]], tuple[str, ...]]:
    """Give the step of an even time axis; with ``repair`` make an uneven one even."""
    time, source, seconds = samples.time, samples.table.source, samples.seconds
    back = first_step_back(time)
    if back is not None:
        before, after = time[back - 1] * seconds, time[back] * seconds
        raise InputError(
            f"{source}: time goes from {before:.12g} s to {after:.12g} s at "
            f"{samples.place(back)}; it must increase, so sort the file or give a rate instead"
        )
    gap = worst_gap(time)
    if gap.even:
        return samples.step(float(time[-1] - time[0]) / (time.size - 1)), samples.signals, ()
    worst = f"{gap.size * seconds:.6g} s after {samples.place(gap.row)}"
    if not repair:
        raise InputError(
            f"{source}: time is uneven, the worst gap is {worst} and the median gap "
            f"{gap.median * seconds:.6g} s (tolerance {TOLERANCE:.0%}); "
            "resample with the option repair, or give a rate instead"
        )
    step = samples.step(gap.median)
    note = f"resampled linearly onto steps of {step:.6g} s; the worst gap was {worst}"
    return step, resample(time, samples.signals, gap.median), (note,)


def _refuse_own_times(path: str | os.PathLike[str], table: Table, chosen: list[int]) -> None:
    """Refuse one time for both signals where one of them has stamps of its own."""

    def read(column: int) -> NDArray[np.float64]:
        found = table.columns[column]
        # Columns that were not asked for have not been read.
        return found if found.size else read_table(path, columns=[column]).columns[column]

    refuse_own_times(table, {"input": chosen[0], "output": chosen[1]}, chosen[2], read)


def _refuse_clocks(
    rate: float | None,
    clocks: list[int | str | None],
    time_unit: str | None,
    resample: bool,
) -> None:
    """Check that both signals have stamps, or neither and a rate."""
    if rate is not None:
        as_positive(rate, "rate", "the samples per second")
        if resample or any(clock is not None for clock in clocks):
            raise InputError(
                "a rate is given with stamps or resample; signals that were stamped apart need "
                "their stamps, and with a rate there are none"
            )
    elif any(clock is None for clock in clocks):
        raise InputError("a signal has no stamps; give time, or input_time and output_time")
    if time_unit is not None and seconds_per_unit(time_unit) is None:
        raise InputError(f"time_unit is {time_unit!r}; give s, ms, us, ns, min or h")


def _refuse_unusable(source: str, record: Record, dead_band: float | None) -> None:
    """Refuse signals that stand still, and an input that does not turn."""
    for name, signal, role in (
        (record.input_name, record.u, "input"),
        (record.output_name, record.y, "output"),
    ):
        if signal.min() == signal.max():
            raise InputError(
                f"{source}: the {role} {name!r} is {signal[0]:.6g} throughout; "
                "choose a column that moves"
            )
    threshold = suggest_dead_band(record.u) if dead_band is None else dead_band
    count = reversals(record.u, threshold).size
    if count < _FEWEST_REVERSALS:
        raise InputError(
            f"{source}: the input {record.input_name!r} has {count} reversals beyond its "
            f"dead band of {threshold:.3g}, and hysteresis needs at least {_FEWEST_REVERSALS}; "
            "record whole cycles, or set dead_band"
        )

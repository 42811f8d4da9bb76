"""Read a record, or a single column, from a data file."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive
from hyst.errors import InputError
from hyst.io.apart import Apart, read_apart
from hyst.io.codes_in_rows import codes_of_column, refuse_codes
from hyst.io.columns import find_column, refuse_flaws
from hyst.io.entries import MOST_SAMPLES
from hyst.io.formats import choose_table, read_table, read_tables
from hyst.io.record_of_table import Wanted, choose_columns, record_of_table, refuse_unusable
from hyst.io.runs import split_runs
from hyst.io.table import Table
from hyst.io.unit_of_stamps import require_time_unit
from hyst.io.usable_rows import LONGEST_GAP
from hyst.signals import Record


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
    table: int | None = None,
    format: str | None = None,
    longest_gap: int = LONGEST_GAP,
    resample: bool = False,
    hold_input: bool = False,
    input_time: int | str | None = None,
    output_time: int | str | None = None,
    output_file: str | os.PathLike[str] | None = None,
    max_samples: int = MOST_SAMPLES,
    one_way: bool = False,
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
        record's dt is their mean. Stamps that are rounded, or jitter by up to a tenth of a step,
        are taken as even, and the notes say so. Give either this or ``rate``, or neither where
        the file states its step.
    rate
        Samples per second, Hz, > 0.
    time_unit
        Unit of the time column, ``"s"``, ``"ms"``, ``"us"``, ...; by default what its header
        says, and seconds if it says nothing.
    repair
        Leave out rows where a value is missing, not a number or a code of the instrument, take
        stamps that repeat at their mean rate, and interpolate linearly onto the median step where
        the time is uneven. At most 3 rows or 5 % of them, and ``longest_gap`` one after the other.
        What was done is in the record's notes.
    dead_band
        Swings of the input up to this size do not count as reversals, units of the input, >= 0;
        by default ``suggest_dead_band`` of the input.
    table
        Which of several tables that stand below each other in a text file, from 1, or of several
        runs where the time starts again; by default the only one that has the columns.
    format
        Format of the file where neither content nor suffix tells, as for ``read_table``.
    longest_gap
        How many samples in a row ``repair`` may leave out or fill in, >= 0; above 5 without a
        limit of their number altogether.
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
    one_way
        Take an input that does not turn or move too: a ramp or a hold whose answer is wanted.

    Returns
    -------
    Record
        The signals with their names and units; ``notes`` is empty unless something was found out,
        left out or repaired.

    Raises
    ------
    InputError
        If the file cannot be read (see ``read_table``); if both or none of ``time`` and ``rate``
        are given, or one of them is unusable; if a column is missing, given twice, differs in
        length, or holds text, NaN, infinity or codes of an instrument (the first line is named);
        if units contradict each other; if time does not increase or is uneven (the worst gap is
        named); if fewer than 3 samples are left, a signal is constant, or the input neither turns
        twice nor goes through one whole loop.
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
            input=input,
            output=output,
            input_time=clocks[0],
            output_time=clocks[1],
            rate=rate,
            time_unit=time_unit,
            repair=repair,
            resample=resample,
            hold_input=hold_input,
            table=table,
            format=format,
        )
        record = read_apart(path, output_file, where, max_samples)
        refuse_unusable(str(path), record, dead_band, one_way)
        return record
    if hold_input:
        raise InputError("hold_input says how to resample; give it with resample")
    wanted = Wanted(input, output, time, rate, time_unit, repair, dead_band, longest_gap, one_way)
    tables = read_tables(
        path, columns=wanted.used(), max_samples=max_samples, format=format, repair=repair
    )
    chosen = _chosen(_runs(tables, wanted), table, wanted)
    return record_of_table(chosen, wanted, _reading(path, format))


def read_records(
    path: str | os.PathLike[str], input: int | str, output: int | str, **how: Any
) -> tuple[Record, ...]:
    r"""Read every table of a text file as a record, one below the other.

    Parameters
    ----------
    path, input, output
        As for ``read_record``.
    how
        Its options, ``table`` aside.

    Returns
    -------
    tuple of Record
        One for each table that has the columns.

    Raises
    ------
    InputError
        As ``read_record``, and if no table has the columns.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "two.csv"
    >>> rows = "u,y\n0,0\n1,3\n0,1\n1,3\n"
    >>> _ = path.write_text(rows + rows)
    >>> len(read_records(path, "u", "y", rate=10.0))
    2
    """
    format, most = how.pop("format", None), how.pop("max_samples", MOST_SAMPLES)
    apart = ("resample", "hold_input", "input_time", "output_time", "output_file")
    if any(how.pop(each, None) for each in apart):
        raise InputError("signals that were stamped apart are read from one table; give its number")
    wanted = Wanted(input, output, **how)
    tables = read_tables(
        path, columns=wanted.used(), max_samples=most, format=format, repair=wanted.repair
    )
    fitting = [each for each in _runs(tables, wanted) if _fits(each, wanted)] or [tables[0]]
    return tuple(record_of_table(each, wanted, _reading(path, format)) for each in fitting)


def read_column(
    path: str | os.PathLike[str],
    column: int | str,
    *,
    table: int | None = None,
    format: str | None = None,
    max_samples: int = MOST_SAMPLES,
) -> tuple[NDArray[np.float64], str, str]:
    r"""Read a single column of a data file, for instance a wanted trajectory.

    Parameters
    ----------
    path
        The file, of any format of ``read_table``.
    column
        Header, name or 0-based index.
    table, format, max_samples
        As for ``read_table``.

    Returns
    -------
    tuple
        Values (read-only, shape (N,), finite), name and unit.

    Raises
    ------
    InputError
        If the file cannot be read, the column is missing, or it holds text, NaN, infinity or
        codes of an instrument.
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
    whole = read_table(path, columns=[column], table=table, format=format, max_samples=max_samples)
    found = find_column(whole, column)
    refuse_flaws(whole, found, "correct it or take the row out")
    # A single peak of a wanted trajectory is none, unless it is a number that programs write.
    codes = codes_of_column(whole, found, np.arange(whole.columns[found].size))
    refuse_codes(whole, found, tuple(code for code in codes if code.meaning), "")
    return whole.columns[found], whole.names[found], whole.units[found]


def _reading(
    path: str | os.PathLike[str], format: str | None
) -> Callable[[Table, int], NDArray[np.float64]]:
    """Give a column of a table, and read it if it was not asked for before."""

    def read(table: Table, column: int) -> NDArray[np.float64]:
        found = table.columns[column]
        return (
            found
            if found.size
            else read_table(path, columns=[column], format=format).columns[column]
        )

    return read


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
    require_time_unit(time_unit)


def _runs(tables: tuple[Table, ...], wanted: Wanted) -> tuple[Table, ...]:
    """Cut tables where their time starts again."""
    if wanted.time is None:
        return tables
    return tuple(
        run
        for each in tables
        for run in (
            split_runs(each, find_column(each, wanted.time)) if _fits(each, wanted) else (each,)
        )
    )


def _chosen(tables: tuple[Table, ...], table: int | None, wanted: Wanted) -> Table:
    """Give the table to read: the one asked for, or the only one that has the columns."""
    if table is not None or len(tables) == 1:
        return choose_table(tables, table) if table is not None else tables[0]
    fitting = tuple(each for each in tables if _fits(each, wanted))
    return fitting[0] if len(fitting) == 1 else choose_table(tables, None)


def _fits(table: Table, wanted: Wanted) -> bool:
    try:
        choose_columns(table, wanted.columns())
    except InputError:
        return False
    return True

"""What a data file holds: its columns with sizes, units and ranges, and what they may be."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hyst.io.coarse_stamps import coarse_stamps
from hyst.io.codes_in_rows import codes_in_words, codes_of_column
from hyst.io.entries import MOST_SAMPLES, TooManySamples
from hyst.io.formats import read_table
from hyst.io.header import unit_of_time_in_name
from hyst.io.table import Table
from hyst.io.time_axis import first_step_back, worst_gap
from hyst.io.units_of_time import seconds_per_unit
from hyst.io.wrapped_stamps import counted_on

_TIME = re.compile(r"(^|[^a-z])(t|time|stamps?|time ?stamps?|zeit)([^a-z]|$)")
_INPUT = re.compile(
    r"(^|[^a-z])(u|in|input|drive|cmd|command|volt|voltage|current|excitation|actuation|field"
    r"|ref|reference|setpoint|ao\d*|dac)([^a-z]|$)|^h$"
)
_OUTPUT = re.compile(
    r"(^|[^a-z])(y|out|output|pos|position|disp|displacement|stroke|sensor|meas|measured|strain"
    r"|deflection|force|torque|ai\d*|adc)([^a-z]|$)|^b$"
)
_INPUT_UNITS = frozenset({"v", "mv", "kv", "a", "ma", "a/m", "ka/m", "oe", "bar", "pa", "kpa"})
_OUTPUT_UNITS = frozenset(
    {"m", "mm", "um", "\N{MICRO SIGN}m", "nm", "rad", "mrad", "urad", "deg", "n", "t", "nm/m"}
)


@dataclass(frozen=True)
class ColumnSummary:
    """A column of a data file.

    Parameters
    ----------
    index
        Its place, from 0.
    header, name, unit
        As of ``Table``.
    size
        Number of values.
    low, high
        The range of its finite values; NaN if there are none, or too many to read.
    flaw
        What its first entry is that is no finite number, and where; empty if all are.
    guess
        ``input``, ``output``, ``time`` or nothing: what it may be, by name, unit and values.
    """

    index: int
    header: str
    name: str
    unit: str
    size: int
    low: float
    high: float
    flaw: str
    guess: str = ""


@dataclass(frozen=True)
class FileSummary:
    """What a data file holds.

    Parameters
    ----------
    columns
        Its columns in order.
    left_out
        What else it holds: pairs of name and reason.
    """

    columns: tuple[ColumnSummary, ...]
    left_out: tuple[tuple[str, str], ...]


def summarize_file(
    path: str | os.PathLike[str],
    *,
    max_samples: int = MOST_SAMPLES,
    table: int | None = None,
    format: str | None = None,
) -> FileSummary:
    r"""List what a data file holds, with a guess at input, output and time.

    Parameters
    ----------
    path
        The file, of any format of ``read_table``.
    max_samples
        Most numbers to read at a time; columns of more have no range.
    table, format
        As for ``read_table``.

    Returns
    -------
    FileSummary
        The guess is by name, then by unit, then by order, of columns that move and have as many
        values; it is for a person to look at, and nothing in hyst acts on it.

    Raises
    ------
    InputError
        If the file cannot be read.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "loop.csv"
    >>> _ = path.write_text("t [s],drive [V],pos [um]\n0,0,0\n1,2,5\n2,1,3\n")
    >>> [(each.name, each.high, each.guess) for each in summarize_file(path).columns]
    [('t', 2.0, 'time'), ('drive', 2.0, 'input'), ('pos', 5.0, 'output')]
    """
    read = partial(read_table, path, max_samples=max_samples, table=table, format=format)
    try:
        whole = read()
        columns = [whole.columns[k] for k in range(len(whole.names))]
        found = [_summary(whole, k) for k in range(len(whole.names))]
    except TooManySamples:
        whole = read(columns=())
        found, columns = _one_by_one(read, whole)
    guesses = _guess(found, columns)
    named = [
        ColumnSummary(**{**vars(each), "guess": guesses.get(each.index, "")}) for each in found
    ]
    return FileSummary(tuple(named), tuple(whole.left_out.items()))


def _one_by_one(
    read: Callable[..., Table], table: Table
) -> tuple[list[ColumnSummary], list[NDArray[np.float64]]]:
    """Summarize a file that is too large to be read as a whole."""
    found: list[ColumnSummary] = []
    for k in range(len(table.names)):
        try:
            found.append(_summary(read(columns=[k]), k))
        except TooManySamples as refusal:
            said = (k, table.headers[k], table.names[k], table.units[k], refusal.samples)
            found.append(ColumnSummary(*said, np.nan, np.nan, "not read"))
    return found, [np.empty(0)] * len(found)


def _summary(table: Table, k: int) -> ColumnSummary:
    values, flaw = table.columns[k], table.flaws[k]
    finite = values[np.isfinite(values)] if flaw is not None else values
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (np.nan, np.nan)
    said = ""
    if flaw is not None:
        others = values.size - finite.size
        what = repr(flaw.text[:20]) if flaw.text else "no value"
        said = f"{what} at {table.place(flaw.row)}, {others} in all"
    rows = np.flatnonzero(np.isfinite(values))
    codes = codes_in_words(table, k, codes_of_column(table, k, rows))
    said = "; ".join([said, *codes] if said else codes)
    names = (k, table.headers[k], table.names[k], table.units[k], int(values.size))
    return ColumnSummary(*names, low, high, said)


def _guess(found: list[ColumnSummary], columns: list[NDArray[np.float64]]) -> dict[int, str]:
    """Guess time, then output and input of one length among the columns that move."""
    rising = [each for each in found if _rises(columns[each.index])]
    called = [each for each in found if _is_called_time(each)]
    times = [each for each in called if each in rising or _goes_on(columns[each.index])]
    times += [each for each in rising if each not in times and _is_clock(each, columns)]
    moving = [each for each in found if each.low < each.high and each not in times]
    moving = [each for each in moving if each not in rising] or moving
    guesses: dict[int, str] = {}
    u = _best(moving, _INPUT, _INPUT_UNITS, _OUTPUT)
    if u is not None:
        guesses[u.index] = "input"
        alike = [each for each in moving if each is not u and each.size == u.size]
        y = _best(alike, _OUTPUT, _OUTPUT_UNITS, _INPUT)
        if y is not None:
            guesses[y.index] = "output"
        times = [each for each in times if each.size == u.size]
    if times:
        guesses[times[0].index] = "time"
    return guesses


def _is_called_time(column: ColumnSummary) -> bool:
    said = _TIME.search(_words(column)) is not None
    return said or bool(unit_of_time_in_name(column.name)) or _is_time_unit(column.unit)


def _is_time_unit(unit: str) -> bool:
    return bool(unit) and seconds_per_unit(unit) is not None


def _is_clock(column: ColumnSummary, columns: list[NDArray[np.float64]]) -> bool:
    """Tell whether a rising column has a unit of time, or even steps."""
    if column.unit:
        return _is_time_unit(column.unit)
    return not column.flaw and worst_gap(columns[column.index]).even


def _best(
    among: list[ColumnSummary],
    words: re.Pattern[str],
    units: frozenset[str],
    others: re.Pattern[str],
) -> ColumnSummary | None:
    """Choose by name before unit before order."""

    def score(each: ColumnSummary) -> float:
        said = _words(each)
        by_name = 4.0 * bool(words.search(said)) - 3.0 * bool(others.search(said))
        return by_name + 2.0 * (each.unit.strip().lower() in units)

    return max(among, key=score, default=None)


def _words(column: ColumnSummary) -> str:
    """Give the name with its words apart, in small letters."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", column.name).lower().replace("_", " ")


def _rises(values: NDArray[np.float64]) -> bool:
    finite = values[np.isfinite(values)]
    return finite.size > 1 and first_step_back(finite) is None


def _goes_on(values: NDArray[np.float64]) -> bool:
    """Tell whether stamps repeat because their clock is slow, or start again because it is full."""
    finite = values[np.isfinite(values)]
    if finite.size < 2:
        return False
    return coarse_stamps(finite) is not None or counted_on(finite) is not None

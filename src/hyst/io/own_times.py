"""Two signals that were stamped apart: found out, and brought to one raster."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.table import Table
from hyst.io.time_axis import TOLERANCE, first_step_back, worst_gap

Array = NDArray[np.float64]

_FEWEST = 3
# Longer gaps of a signal are holes, which a straight line would fill with inventions.
_LONGEST_GAP = 10.0
_SAME_ROW = 0.5
_TIME = re.compile(r"(time[ _-]?stamps?|timestamps?|stamps?|times?|x[ _-]?value|t)", re.IGNORECASE)
_REST = re.compile(r"[\s_\-./:()\[\]\d]*")


@dataclass(frozen=True, eq=False)
class Stamped:
    """A signal with stamps of its own.

    Parameters
    ----------
    name, unit
        Of the signal.
    time
        Stamps, s, shape (N,), increasing.
    values
        Shape (N,), finite.
    notes
        What was found out about them; sentences.
    """

    name: str
    unit: str
    time: Array
    values: Array
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class OneRaster:
    """Two signals on one even raster.

    Parameters
    ----------
    dt
        Its step, s.
    u, y
        The signals, shape (N,).
    notes
        What was done, and the error it costs; sentences.
    """

    dt: float
    u: Array
    y: Array
    notes: tuple[str, ...]


def on_one_raster(u: Stamped, y: Stamped, source: str, *, hold_input: bool = False) -> OneRaster:
    """Bring two signals to one raster: the stamps of the slower one if they are even.

    The other one is interpolated linearly; its last value is held for less than one of its steps.
    If the stamps of the slower one are not even, both are brought onto its median step.

    Parameters
    ----------
    u, y
        Input and output.
    source
        Name of the file, for messages.
    hold_input
        Whether the input keeps each value until its next stamp, as a command to a converter does.

    Returns
    -------
    OneRaster
        With the interpolation's error: next to a corner of the signal a straight line is off by
        up to ``f (1 - f) h (|s_k - s_{k-1}| + |s_{k+1} - s_k|)``, with s the slopes between
        samples, h the gap and f the place in it; where the signal is smooth, by a quarter of that.

    Raises
    ------
    InputError
        If the signals share less than 3 samples of time, or one of them has a hole.

    Examples
    --------
    >>> import numpy as np
    >>> fast = Stamped("u", "V", np.arange(8) / 2.0, np.arange(8.0) ** 2)
    >>> slow = Stamped("y", "um", np.arange(4.0), np.arange(4.0))
    >>> both = on_one_raster(fast, slow, "run.csv")
    >>> both.dt, both.u.tolist()
    (1.0, [0.0, 4.0, 16.0, 36.0])
    """
    steps = [worst_gap(signal.time).median for signal in (u, y)]
    slow = u if steps[0] > steps[1] * (1.0 + TOLERANCE) else y
    grid, kept = _raster(u, y, slow, source)
    if grid.size < _FEWEST:
        raise InputError(
            f"{source}: {u.name!r} runs from {u.time[0]:.6g} s to {u.time[-1]:.6g} s and "
            f"{y.name!r} from {y.time[0]:.6g} s to {y.time[-1]:.6g} s, which is {grid.size} "
            "samples in common; check the stamps and their units"
        )
    dt = float(f"{(grid[-1] - grid[0]) / (grid.size - 1):.12g}")
    where = f"the stamps of {slow.name!r}" if kept else "even steps"
    notes = [f"brought to {where}: {grid.size} samples, step {dt:.6g} s"]
    for signal in (u, y):
        if not (kept and signal is slow):
            notes.append(_told(signal, grid, signal is u, hold_input))
        outside = np.count_nonzero((signal.time < grid[0]) | (signal.time > grid[-1]))
        if outside:
            notes.append(
                f"left out {outside} of {signal.time.size} samples of {signal.name!r}, outside the "
                "common time"
            )
    values = [np.interp(grid, signal.time, signal.values) for signal in (u, y)]
    if hold_input:
        # A stamp that rounding has put just before its instant counts.
        last = np.searchsorted(u.time, grid + 1e-6 * dt, "right") - 1
        values[0] = u.values[np.maximum(last, 0)]
    return OneRaster(dt, values[0], values[1], tuple(notes))


def _raster(u: Stamped, y: Stamped, slow: Stamped, source: str) -> tuple[Array, bool]:
    """Give the raster, and whether it is the stamps of the slower signal themselves."""
    low = max(u.time[0], y.time[0])
    ends = [signal.time[-1] + 0.999 * worst_gap(signal.time).median for signal in (u, y)]
    high = min(max(u.time[-1], y.time[-1]), *ends)
    gap = worst_gap(slow.time)
    for signal in (u, y):
        hole = worst_gap(signal.time)
        if hole.size > _LONGEST_GAP * hole.median:
            raise InputError(
                f"{source}: {signal.name!r} has no value for {hole.size:.6g} s after "
                f"{signal.time[hole.row]:.6g} s, and its median gap is {hole.median:.6g} s; cut "
                "the record at the hole"
            )
    near = 1e-6 * gap.median
    inside = slow.time[(slow.time >= low - near) & (slow.time <= high + near)]
    if gap.even or inside.size < _FEWEST:
        return inside, True
    start, end = inside[0], min(inside[-1], u.time[-1], y.time[-1])
    return start + gap.median * np.arange(int((end - start) / gap.median + 1e-6) + 1), False


def _told(signal: Stamped, grid: Array, is_input: bool, hold_input: bool) -> str:
    """Say what was done to a signal; what an input does between its stamps only the user knows."""
    if is_input and hold_input:
        return f"{signal.name!r} keeps each value until its next stamp"
    said = _cost(signal, grid)
    if not is_input or "costs" not in said:
        return said
    return f"{said}; if it is a command that is held until its next stamp, give hold_input"


def _cost(signal: Stamped, grid: Array) -> str:
    """Say how many samples were interpolated, and what that costs."""
    index = np.clip(np.searchsorted(signal.time, grid, "right") - 1, 0, signal.time.size - 2)
    gaps, place = np.diff(signal.time), grid - signal.time[index]
    share = np.clip(place / gaps[index], 0.0, None)
    between = (share > 1e-6) & (np.abs(share - 1.0) > 1e-6)
    unit = f" {signal.unit}" if signal.unit else ""
    if not between.any():
        return f"{signal.name!r} has a sample at each of them"
    slopes = np.diff(signal.values) / gaps
    bends = np.abs(np.diff(slopes, prepend=slopes[0], append=slopes[-1]))
    line = share * (1.0 - share) * gaps[index] * (bends[index] + bends[index + 1])
    held = np.abs(slopes[index]) * (place - gaps[index])
    worst = float(np.where(share > 1.0, held, line)[between].max())
    late = np.count_nonzero(share > 1.0 + 1e-6)
    span = float(np.ptp(signal.values))
    part = f" ({100.0 * worst / span:.2g} % of its range)" if span > 0.0 else ""
    how = f", its last value held at {late}," if late else ","
    return (
        f"{signal.name!r} interpolated linearly at {np.count_nonzero(between)} of them{how} which "
        f"costs up to about {worst:.3g}{unit}{part}"
    )


def refuse_own_times(
    table: Table, signals: Mapping[str, int], time: int, read: Callable[[int], Array]
) -> None:
    """Refuse a time column where a signal has another one beside it, by name and by stamps.

    Parameters
    ----------
    table
        Where the columns are.
    signals
        Columns of the input and of the output, by role.
    time
        The time column chosen for both.
    read
        Gives a column by its index, read already or not.

    Raises
    ------
    InputError
        If a signal has stamps of its own.
    """
    for role, column in signals.items():
        for k in range(len(table.names)):
            if k in {time, column} or not _is_time_of(table, k, column, time):
                continue
            if _other_stamps(table.columns[time], read(k), table.columns[column]):
                raise InputError(
                    f"{table.source}: {table.names[column]!r} has its own stamps in "
                    f"{table.headers[k]!r}, other ones than {table.headers[time]!r}; give "
                    f"{role}_time and resample, which brings both signals to one raster"
                )


def refuse_rows_apart(table: Table, columns: list[int]) -> None:
    """Refuse two columns of a table that seldom have a value in one row: they were logged apart.

    Raises
    ------
    InputError
        If so.
    """
    finite = [np.isfinite(table.columns[k]) for k in columns]
    if len(finite) < 2 or finite[0].size != finite[1].size:
        return
    both, either = (finite[0] & finite[1]).sum(), (finite[0] | finite[1]).sum()
    if 2 * both < min(finite[0].sum(), finite[1].sum()):
        names = " and ".join(repr(table.names[k]) for k in columns)
        raise InputError(
            f"{table.source}: {names} have a value together in {both} of {either} rows only, so "
            "each was logged at its own times; the option resample brings both to one raster"
        )


def _is_time_of(table: Table, place: int, column: int, time: int) -> bool:
    """Tell whether a column is the time of a signal: by its name, its place or its group."""
    name, signal = table.names[place].casefold(), table.names[column].casefold()
    if signal in name and _is_time(name.replace(signal, "", 1)):
        return True
    if place == column - 1 and _is_time(name):
        return True
    header = table.headers[place]
    cut = max(header.rfind("."), header.rfind("/")) + 1
    group, leaf = header[:cut], header[cut:]
    inside = bool(group) and table.headers[column].startswith(group)
    return inside and _is_time(leaf) and not table.headers[time].startswith(group)


def _is_time(name: str) -> bool:
    found = _TIME.search(name)
    if found is None:
        return False
    return _REST.fullmatch(name[: found.start()] + name[found.end() :]) is not None


def _other_stamps(time: Array, other: Array, signal: Array) -> bool:
    """Tell whether a column has a stamp for each value of a signal, and other stamps."""
    stamps = other[np.isfinite(other)]
    if stamps.size < _FEWEST or first_step_back(stamps) is not None:
        return False
    if stamps.size != np.count_nonzero(np.isfinite(signal)):
        return False
    first = time[np.isfinite(time)]
    if stamps.size != first.size:
        return True
    apart, step = stamps - first, np.median(np.diff(stamps))
    # Channels that are scanned one after the other within a step are of one row all the same, and
    # stamps further apart than the record is long count from another instant.
    shift = float(np.median(np.abs(apart)))
    shifted = _SAME_ROW * step < shift < np.ptp(first)
    return bool(np.ptp(apart) > TOLERANCE * step or shifted)

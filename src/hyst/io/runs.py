"""Runs that follow each other in one table: where the time starts again, so does a record."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from hyst.io.table import Table, first_flaw
from hyst.io.wrapped_stamps import counted_on

_FEWEST_ROWS = 3
_AT_START = 2.0


def split_runs(table: Table, time: int) -> tuple[Table, ...]:
    """Cut a table where its time starts again.

    Parameters
    ----------
    table
        What was read.
    time
        Its column of time.

    Returns
    -------
    tuple of Table
        One for each run; the table as it is unless every fall of the time is back to its start,
        within two steps, and a full counter does not explain it.

    Examples
    --------
    >>> t = np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0])
    >>> table = Table("a.csv", ("t",), ("",), (t,), ("t",), (None,))
    >>> [each.columns[0].size for each in split_runs(table, 0)]
    [3, 3]
    """
    stamps = table.columns[time]
    if stamps.size < 2 * _FEWEST_ROWS or not np.isfinite(stamps).all():
        return (table,)
    with np.errstate(over="ignore"):
        gaps = np.diff(stamps)
        falls, rises = np.flatnonzero(gaps < 0.0), gaps[gaps > 0.0]
        if not falls.size or not rises.size or counted_on(stamps) is not None:
            return (table,)
        away = np.abs(stamps[falls + 1] - stamps[0])
    if away.max() > _AT_START * float(np.median(rises)):
        return (table,)
    edges = [0, *(falls + 1).tolist(), stamps.size]
    if min(np.diff(edges)) < _FEWEST_ROWS:
        return (table,)
    return tuple(_part(table, a, b) for a, b in itertools.pairwise(edges))


def _part(table: Table, start: int, stop: int) -> Table:
    size = max(column.size for column in table.columns)
    # Columns of other lengths, and those that were not read, have no part in a run.
    columns = tuple(c[start:stop] if c.size == size else c[:0] for c in table.columns)
    return replace(
        table,
        columns=columns,
        flaws=tuple(first_flaw(column) for column in columns),
        lines=None if table.lines is None else table.lines[start:stop],
    )

"""The time step of a file that need not have one."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import NDArray

from hyst.io.formats import read_table
from hyst.io.table import Table, first_flaw
from hyst.io.time_axis import first_step_back, worst_gap
from hyst.io.units_of_time import seconds_per_unit

_NAMES = ("t", "time")


def read_time_step(path: str | os.PathLike[str]) -> tuple[str, float | None] | None:
    r"""Read the time step from a column named t or time, if there is one.

    Parameters
    ----------
    path
        The file, of any format of ``read_table``.

    Returns
    -------
    tuple or None
        The column's header, and the mean step, seconds, or None if it is not even to 1 % or its
        unit unknown. None if there is no such column.

    Raises
    ------
    InputError
        If the file cannot be read.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "wanted.csv"
    >>> _ = path.write_text("Time (ms),y\n0,1\n5,2\n10,1\n")
    >>> read_time_step(path)
    ('Time (ms)', 0.005)
    """
    found, table = _time_column(path)
    if found is None:
        return None
    header, time = table.headers[found], table.columns[found]
    seconds = seconds_per_unit(table.units[found])
    if seconds is None or time.size < 2 or first_flaw(time) is not None:
        return header, None
    if first_step_back(time) is not None or not worst_gap(time).even:
        return header, None
    return header, float(time[-1] - time[0]) / (time.size - 1) * seconds


def read_time_column(
    path: str | os.PathLike[str],
) -> tuple[str, NDArray[np.float64]] | None:
    r"""Read the column named t or time, if there is one with a finite stamp in every row.

    Parameters
    ----------
    path
        The file, of any format of ``read_table``.

    Returns
    -------
    tuple or None
        The column's header, and its values as they stand in the file, shape (N,).

    Raises
    ------
    InputError
        If the file cannot be read.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "wanted.csv"
    >>> _ = path.write_text("Time (ms),y\n0,1\n5,2\n10,1\n")
    >>> read_time_column(path)
    ('Time (ms)', array([ 0.,  5., 10.]))
    """
    found, table = _time_column(path)
    if found is None or table.flaws[found] is not None:
        return None
    return table.headers[found], table.columns[found]


def _time_column(path: str | os.PathLike[str]) -> tuple[int | None, Table]:
    """Find the column of stamps and read it, and of a binary file nothing else."""
    table = read_table(path, columns=())
    found = [k for k, name in enumerate(table.names) if name.strip().lower() in _NAMES]
    if not found:
        return None, table
    if not table.columns[found[0]].size:
        table = read_table(path, columns=[found[0]])
    return found[0], table

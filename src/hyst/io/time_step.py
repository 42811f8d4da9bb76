"""The time step of a file that need not have one."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.even_time import Samples, on_even_steps
from hyst.io.formats import read_table
from hyst.io.header import is_time
from hyst.io.table import Table
from hyst.io.unit_of_stamps import unit_of_stamps


def read_time_step(path: str | os.PathLike[str], **how: Any) -> tuple[str, float | None] | None:
    r"""Read the time step from a column called as times are, if there is one.

    Parameters
    ----------
    path
        The file, of any format of ``read_table``.
    how
        Options of ``read_table``: table, format, max_samples.

    Returns
    -------
    tuple or None
        The column's header, and the mean step, seconds, or None if it is not even or its
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
    found, table = _time_column(path, **how)
    if found is None:
        return None
    header, time = table.headers[found], table.columns[found]
    if time.size < 2 or table.flaws[found] is not None:
        return header, None
    try:
        seconds, _ = unit_of_stamps(table, found, time, None)
        rows = np.arange(time.size)
        samples = Samples(table, rows, time, seconds, [], rate_given=False)
        return header, on_even_steps(samples, repair=False, longest_gap=0).dt
    except InputError:
        return header, None


def read_time_column(
    path: str | os.PathLike[str], **how: Any
) -> tuple[str, NDArray[np.float64]] | None:
    r"""Read the column called as times are, if there is one with a finite stamp in every row.

    Parameters
    ----------
    path
        The file, of any format of ``read_table``.
    how
        Options of ``read_table``: table, format, max_samples.

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
    found, table = _time_column(path, **how)
    if found is None or table.flaws[found] is not None:
        return None
    return table.headers[found], table.columns[found]


def _time_column(path: str | os.PathLike[str], **how: Any) -> tuple[int | None, Table]:
    """Find the column of stamps and read it, and of a binary file nothing else."""
    table = read_table(path, columns=(), **how)
    found = [k for k, name in enumerate(table.names) if is_time(name)]
    if not found:
        return None, table
    if not table.columns[found[0]].size:
        table = read_table(path, columns=[found[0]], **how)
    return found[0], table

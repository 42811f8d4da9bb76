"""The time step of a file that need not have one."""

from __future__ import annotations

import os

from hyst.io.formats import read_table
from hyst.io.table import first_flaw
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
    table = read_table(path)
    found = [k for k, name in enumerate(table.names) if name.strip().lower() in _NAMES]
    if not found:
        return None
    header, time = table.headers[found[0]], table.columns[found[0]]
    seconds = seconds_per_unit(table.units[found[0]])
    if seconds is None or time.size < 2 or first_flaw(time) is not None:
        return header, None
    if first_step_back(time) is not None or not worst_gap(time).even:
        return header, None
    return header, float(time[-1] - time[0]) / (time.size - 1) * seconds

"""Write signals as a CSV file that gives back every double exactly."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from typing import Any

from numpy.typing import NDArray

from hyst._files import replacing


def write_columns(
    path: str | os.PathLike[str],
    headers: Sequence[str],
    columns: Sequence[NDArray[Any]],
) -> None:
    """Write columns of numbers under headers, separated by commas.

    Parameters
    ----------
    path
        The file to create or replace, whole or not at all.
    headers
        One for each column, for instance ``voltage [V]``.
    columns
        Vectors of one length, of real or whole numbers.

    Raises
    ------
    InputError
        If the folder does not exist or the path is a folder.

    Examples
    --------
    >>> import pathlib, tempfile, numpy as np
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "out.csv"
    >>> write_columns(path, ["u [V]", "y"], [np.array([0.1, 1.0]), np.array([1 / 3, 2.0])])
    >>> path.read_text().split()
    ['u', '[V],y', '0.1,0.3333333333333333', '1.0,2.0']
    """
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headers)
        # tolist() gives Python floats, whose shortest text names exactly one double.
        writer.writerows(zip(*(column.tolist() for column in columns), strict=True))


def join_unit(name: str, unit: str) -> str:
    """Make the header of a column from its name and unit, as ``split_unit`` takes it apart.

    Parameters
    ----------
    name
        Name of the column.
    unit
        Its unit; empty for none.

    Examples
    --------
    >>> join_unit("voltage", "V"), join_unit("voltage", "")
    ('voltage [V]', 'voltage')
    """
    return f"{name} [{unit}]" if unit else name

"""Write signals as a CSV file that gives back every double exactly."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst._engine import has_number_text, rows_as_text
from hyst._files import replacing

# Rows that are turned into text at a time.
_ROWS = 1 << 16


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
    with replacing(path) as temporary, temporary.open("wb") as file:
        head = io.StringIO()
        csv.writer(head, lineterminator="\n").writerow(headers)
        file.write(head.getvalue().encode("utf-8"))
        for rows in rows_of_text(columns):
            file.write(rows)


def rows_of_text(columns: Sequence[NDArray[Any]]) -> Iterator[bytes]:
    r"""Write numbers with the fewest digits that name each double, as ``repr`` does.

    Parameters
    ----------
    columns
        Vectors of one length, of real or whole numbers.

    Yields
    ------
    bytes
        Some lines each, separated by commas.

    Raises
    ------
    ValueError
        If their lengths differ.

    Examples
    --------
    >>> import numpy as np
    >>> b"".join(rows_of_text([np.array([0.1, 1e22]), np.array([2, 3])])).decode().splitlines()
    ['0.1,2', '1e+22,3']
    """
    sizes = {column.size for column in columns}
    if len(sizes) > 1:
        raise ValueError(f"columns have different lengths, {sorted(sizes)}")
    doubles = all(column.dtype == np.float64 for column in columns) and has_number_text()
    whole = [np.ascontiguousarray(column) for column in columns]
    rows = max(sizes, default=0)
    for start in range(0, rows, _ROWS):
        stop = min(start + _ROWS, rows)
        if doubles:
            yield rows_as_text(whole, start, stop)
        else:
            # tolist() gives Python numbers, whose text is the shortest there is.
            cells = zip(*(column[start:stop].tolist() for column in whole), strict=True)
            yield "".join(",".join(map(repr, row)) + "\n" for row in cells).encode("ascii")


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

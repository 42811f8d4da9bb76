"""Turn named arrays, as MAT, HDF5 and NPZ files hold them, into columns."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.table import Table, table_of


def table_of_arrays(
    source: str, arrays: Mapping[str, object], units: Mapping[str, str] | None = None
) -> Table:
    """Make columns of the arrays of real numbers and leave out everything else.

    A vector, (N, 1) or (1, N) is one column under its own name. The longer axis of a matrix is
    taken as the samples, and its other axis gives the columns ``name[0]``, ``name[1]``, ... A
    square matrix is taken by its columns. Scalars, texts, complex numbers and arrays of more
    axes are no columns.

    Parameters
    ----------
    source
        Name of the file.
    arrays
        Whatever the file holds, by name.
    units
        Units of the arrays that have one.

    Returns
    -------
    Table
        The columns, in the order of ``arrays``.

    Raises
    ------
    InputError
        If none of the arrays is a column.

    Examples
    --------
    >>> table = table_of_arrays("a.npz", {"t": np.arange(3), "x": np.zeros((3, 2)), "n": 5})
    >>> table.names
    ('t', 'x[0]', 'x[1]')
    """
    columns: dict[str, NDArray[np.float64]] = {}
    units_of_columns: dict[str, str] = {}
    for name, array in arrays.items():
        for column_name, column in _columns(name, array):
            columns[column_name] = column
            units_of_columns[column_name] = (units or {}).get(name, "")
    if not columns:
        raise InputError(
            f"{source} holds no array of at least 2 real numbers; "
            "save the signals as numeric vectors"
        )
    return table_of(source, columns, units_of_columns)


def _columns(name: str, array: object) -> list[tuple[str, NDArray[np.float64]]]:
    if not isinstance(array, np.ndarray) or array.dtype.kind not in "biuf" or array.size < 2:
        return []
    if array.ndim == 1 or (array.ndim == 2 and 1 in array.shape):
        return [(name, _vector(array.ravel()))]
    if array.ndim != 2:
        return []
    matrix = array if array.shape[0] >= array.shape[1] else array.T
    return [(f"{name}[{k}]", _vector(matrix[:, k])) for k in range(matrix.shape[1])]


def _vector(array: NDArray[np.generic]) -> NDArray[np.float64]:
    return np.array(array, dtype=np.float64, order="C")

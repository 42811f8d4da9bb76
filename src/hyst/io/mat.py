"""Read the variables of a MATLAB file, version 4 to 7.3."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path

from hyst.errors import InputError
from hyst.io.hdf5 import is_hdf5, read_hdf5
from hyst.io.mat5 import is_mat5, read_mat5
from hyst.io.table import Table
from hyst.io.variables import table_of_arrays

SUFFIXES = (".mat",)


def read_mat(path: Path) -> Table:
    """Read all numeric variables of a MATLAB file.

    Fields of a struct are named ``struct.field``. Cells, texts, complex and sparse arrays and
    objects are left out.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Table
        Columns named after the variables, see ``table_of_arrays``.

    Raises
    ------
    InputError
        If the file is damaged or no MATLAB file, or holds no column.
    MissingExtraError
        If it is of version 7.3 and h5py is not installed.
    """
    if is_hdf5(path):
        return read_hdf5(path, separator=".")
    data = path.read_bytes()
    try:
        arrays = read_mat5(data) if is_mat5(data) else _read_mat4(path)
    except (ValueError, RecursionError, zlib.error) as error:
        raise InputError(f"{path} is damaged or no MATLAB file ({error}); save it again") from error
    return table_of_arrays(str(path), arrays)


def _read_mat4(path: Path) -> Mapping[str, object]:
    """Read a file of the format before MATLAB 5, which has no mark to be known by."""
    # Imported here because it takes longer than all of hyst.
    from scipy.io import loadmat

    with path.open("rb") as file:
        if 0 not in file.read(4):
            raise ValueError("no mark of any version")
    try:
        variables: Mapping[str, object] = loadmat(path)
    # A damaged file fails anywhere in SciPy's parser, with any exception.
    except Exception as error:
        raise ValueError(f"level 4, {type(error).__name__}") from error
    return {name: value for name, value in variables.items() if not name.startswith("__")}

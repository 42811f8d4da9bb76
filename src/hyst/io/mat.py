"""Read the variables of a MATLAB file, version 4 to 7.3."""

from __future__ import annotations

import mmap
import struct
import zlib
from pathlib import Path

from hyst.errors import InputError
from hyst.io.entries import Contents, Wanted, table_of_entries
from hyst.io.hdf5 import is_hdf5, read_hdf5
from hyst.io.mat4 import read_mat4
from hyst.io.mat5 import is_mat5, read_mat5
from hyst.io.mat_objects import label_signals
from hyst.io.table import Table

SUFFIXES = (".mat",)


def read_mat(path: Path, wanted: Wanted) -> Table:
    """Read the numeric variables of a MATLAB file.

    What structs and cells hold is named as in MATLAB, ``s.field``, ``s(2).field``, ``c{1}``; a
    signal with its label or name beside it in a struct (Simulink, dSPACE) goes by that, too. Texts,
    sparse arrays, objects, and complex numbers with an imaginary part are left out.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.

    Returns
    -------
    Table
        Columns named after the variables, see ``columns_of``.

    Raises
    ------
    InputError
        If the file is damaged or no MATLAB file, holds no column, or more than is allowed.
    MissingExtraError
        If it is of version 7.3 and h5py is not installed.
    """
    if is_hdf5(path):
        return read_hdf5(path, wanted, separator=".")
    # Mapped and not read: what is not wanted costs nothing.
    with path.open("rb") as file:
        data = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    contents = Contents()
    try:
        if is_mat5(data):
            read_mat5(data, contents, 8 * wanted.most)
        else:
            read_mat4(data, contents)
        label_signals(contents)
        return table_of_entries(str(path), contents.entries("."), wanted, contents.left_out)
    except InputError:
        raise
    except (ValueError, RecursionError, zlib.error, struct.error) as error:
        raise InputError(f"{path} is damaged or no MATLAB file ({error}); save it again") from error

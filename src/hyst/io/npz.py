"""Read the arrays of an NPZ archive; nothing is ever unpickled."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import BinaryIO

import numpy as np

from hyst.errors import InputError
from hyst.io.table import Table
from hyst.io.variables import table_of_arrays

SUFFIXES = (".npz",)


def read_npz(path: Path) -> Table:
    """Read all arrays of an NPZ archive.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Table
        Columns named after the arrays, see ``table_of_arrays``.

    Raises
    ------
    InputError
        If an array holds Python objects, which are stored as pickles and could run code on being
        read; if the archive is damaged, or holds no column.
    """
    arrays: dict[str, object] = {}
    name = ""
    try:
        # Opened here, because NumPy leaves a file open that turns out to be damaged.
        with path.open("rb") as file:
            _refuse_unless_zip(file)
            with np.load(file, allow_pickle=False) as archive:
                for name in archive.files:
                    arrays[name] = archive[name]
    # A damaged archive fails in zipfile, zlib, struct, ast or NumPy, each with its own exception.
    except Exception as error:
        if "allow_pickle" in str(error):
            raise InputError(
                f"{path}: the array {name!r} holds pickled Python objects, which hyst never loads; "
                "save plain arrays of numbers with numpy.savez"
            ) from error
        raise InputError(
            f"{path} is damaged or no NPZ archive ({type(error).__name__}); save it again"
        ) from error
    return table_of_arrays(str(path), arrays)


def _refuse_unless_zip(file: BinaryIO) -> None:
    """Keep NumPy from trying other formats, a pickle among them."""
    if file.read(2) != b"PK":
        raise zipfile.BadZipFile
    file.seek(0)

"""Read a data file of any known format, chosen by its suffix."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from hyst.errors import InputError
from hyst.io import hdf5, mat, npz, parquet, text
from hyst.io.table import Table

_READERS: dict[str, Callable[[Path], Table]] = {
    **dict.fromkeys(text.SUFFIXES, text.read_text),
    **dict.fromkeys(mat.SUFFIXES, mat.read_mat),
    **dict.fromkeys(hdf5.SUFFIXES, hdf5.read_hdf5),
    **dict.fromkeys(parquet.SUFFIXES, parquet.read_parquet),
    **dict.fromkeys(npz.SUFFIXES, npz.read_npz),
}


def read_table(path: str | os.PathLike[str]) -> Table:
    r"""Read all columns of a data file.

    Parameters
    ----------
    path
        Text (``.csv .tsv .txt .dat .asc .tab .prn``), MATLAB (``.mat``), HDF5
        (``.h5 .hdf5 .hdf``), Parquet (``.parquet .pq``) or NumPy (``.npz``).

    Returns
    -------
    Table
        The columns with their names and units. Text and missing values are NaN; nothing in the
        file is ever executed or unpickled.

    Raises
    ------
    InputError
        If the file is missing, a folder, empty, unreadable, damaged, or of an unknown suffix.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "loop.csv"
    >>> _ = path.write_text("drive [V];stroke [um]\n0,5;1,25\n1,0;2,5\n")
    >>> table = read_table(path)
    >>> table.names, table.units, table.columns[1]
    (('drive', 'stroke'), ('V', 'um'), array([1.25, 2.5 ]))
    """
    file = Path(path)
    if not file.exists():
        raise InputError(f"{file} does not exist; check the path")
    if file.is_dir():
        raise InputError(f"{file} is a folder; name a file in it")
    reader = _READERS.get(file.suffix.lower())
    if reader is None:
        suffix = f"the unknown suffix {file.suffix!r}" if file.suffix else "no suffix"
        raise InputError(f"{file} has {suffix}; hyst reads {' '.join(_READERS)}")
    try:
        if file.stat().st_size == 0:
            raise InputError(f"{file} is empty; give a file with columns of numbers")
        return reader(file)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise InputError(f"{file} cannot be read: {reason}; check the file") from error

"""Read a data file of any known format, chosen by its suffix."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

from hyst.errors import InputError
from hyst.io import hdf5, mat, npz, parquet, tdms, tektronix_isf, tektronix_wfm, text, xlsx
from hyst.io.entries import MOST_SAMPLES, Wanted
from hyst.io.table import Table

_BINARY: dict[str, Callable[[Path, Wanted], Table]] = {
    **dict.fromkeys(mat.SUFFIXES, mat.read_mat),
    **dict.fromkeys(hdf5.SUFFIXES, hdf5.read_hdf5),
    **dict.fromkeys(parquet.SUFFIXES, parquet.read_parquet),
    **dict.fromkeys(tdms.SUFFIXES, tdms.read_tdms),
    **dict.fromkeys(xlsx.SUFFIXES, xlsx.read_xlsx),
    **dict.fromkeys(tektronix_isf.SUFFIXES, tektronix_isf.read_isf),
    **dict.fromkeys(tektronix_wfm.SUFFIXES, tektronix_wfm.read_wfm),
    ".npz": npz.read_npz,
    ".npy": npz.read_npy,
}
_KNOWN = (*text.SUFFIXES, *_BINARY)


def read_table(
    path: str | os.PathLike[str],
    *,
    columns: Sequence[int | str] | None = None,
    max_samples: int = MOST_SAMPLES,
) -> Table:
    r"""Read the columns of a data file.

    Parameters
    ----------
    path
        Text (``.csv .tsv .txt .dat .asc .tab .prn``), MATLAB (``.mat``), HDF5 and netCDF-4
        (``.h5 .hdf5 .hdf .nc``), Parquet (``.parquet .pq``), NumPy (``.npy .npz``), LabVIEW
        (``.tdms``), Excel (``.xlsx .xlsm``), or Tektronix (``.isf .wfm``).
    columns
        The columns to read, as ``find_column`` takes them; by default all. Those of a binary file
        that are not wanted cost no memory and have no values in the table.
    max_samples
        Most numbers to read, all columns together. What a file declares is checked before there
        is memory for it.

    Returns
    -------
    Table
        The columns with their names and units. Text and missing values are NaN; nothing in the
        file is ever executed or unpickled.

    Raises
    ------
    InputError
        If the file is missing, no regular file, empty, unreadable, damaged, of an unknown suffix,
        or holds more than is allowed.
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
    if not file.is_file():
        raise InputError(f"{file} is a device or a pipe, not a regular file; save it as a file")
    suffix = file.suffix.lower()
    if suffix not in _KNOWN:
        said = f"the unknown suffix {file.suffix!r}" if file.suffix else "no suffix"
        raise InputError(f"{file} has {said}; hyst reads {' '.join(_KNOWN)}")
    try:
        if file.stat().st_size == 0:
            raise InputError(f"{file} is empty; give a file with columns of numbers")
        if suffix in _BINARY:
            wanted = Wanted(None if columns is None else tuple(columns), int(max_samples))
            return _BINARY[suffix](file, wanted)
        return text.read_text(file)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise InputError(f"{file} cannot be read: {reason}; check the file") from error

"""Read the data sets of an HDF5 file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from hyst.errors import InputError, MissingExtraError
from hyst.io.table import Table
from hyst.io.variables import table_of_arrays

SUFFIXES = (".h5", ".hdf5", ".hdf")
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_MATLAB_NUMBERS = frozenset(
    [
        "double",
        "single",
        "logical",
        *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
    ]
)


def is_hdf5(path: Path) -> bool:
    """Tell whether a file is HDF5, at its start or after the 512 bytes MATLAB puts before it."""
    with path.open("rb") as file:
        start = file.read(512 + len(_SIGNATURE))
    return start.startswith(_SIGNATURE) or start[512:] == _SIGNATURE


def read_hdf5(path: Path, separator: str = "/") -> Table:
    """Read all numeric data sets of an HDF5 file; links to other files are not followed.

    Parameters
    ----------
    path
        The file.
    separator
        What stands between the groups of a name.

    Returns
    -------
    Table
        Columns named by their full path (``group/voltage``), see ``table_of_arrays``; units from
        the attribute ``units`` or ``unit``.

    Raises
    ------
    InputError
        If the file is damaged or no HDF5 file, or holds no column.
    MissingExtraError
        If h5py is not installed.
    """
    try:
        import h5py
    except ImportError as error:
        raise MissingExtraError(
            f'{path}: HDF5 and MATLAB 7.3 files need h5py; pip install "hyst[files]"'
        ) from error
    arrays: dict[str, object] = {}
    units: dict[str, str] = {}

    def collect(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and _is_numeric(name, item):
            label = name.replace("/", separator)
            # MATLAB stores columns first; only a square matrix cannot be told by its shape.
            arrays[label] = item[()].T if "MATLAB_class" in item.attrs else item[()]
            units[label] = _text(item.attrs.get("units", item.attrs.get("unit", "")))

    try:
        with h5py.File(path, "r") as file:
            file.visititems(collect)
    # A damaged file fails anywhere in the HDF5 library, with any exception.
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no HDF5 file ({type(error).__name__}); save it again"
        ) from error
    return table_of_arrays(str(path), arrays, units)


def _is_numeric(name: str, item: Any) -> bool:
    if item.shape is None or item.dtype.kind not in "biuf" or item.external:
        return False
    if name.startswith("#") or "MATLAB_empty" in item.attrs:
        return False
    return _text(item.attrs.get("MATLAB_class", "double")) in _MATLAB_NUMBERS


def _text(value: object) -> str:
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    if isinstance(value, bytes):
        return value.decode("utf-8", errors="replace")
    return value if isinstance(value, str) else ""

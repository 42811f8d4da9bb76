"""Read the arrays of NPY and NPZ files; nothing is ever unpickled."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import HystError, InputError
from hyst.io.entries import Contents, Selector, Stored, Wanted, table_of_entries
from hyst.io.table import Table

_MASK_OF = ("{}_mask", "mask_{}", "{}.mask")


def read_npz(path: Path, wanted: Wanted) -> Table:
    """Read the arrays of an NPZ archive.

    What stands in an array of truth values called ``mask`` beside ``data``, or ``u_mask`` beside
    ``u``, is taken as the mask of it.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.

    Returns
    -------
    Table
        Columns named after the arrays, see ``columns_of``.

    Raises
    ------
    InputError
        If an array holds Python objects, which are stored as pickles and could run code on being
        read; if the archive is damaged, holds no column, or more than is allowed.
    """
    contents = Contents()
    try:
        # Opened here, because NumPy leaves a file open that turns out to be damaged.
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            for member in archive.namelist():
                if member.endswith(".npy"):
                    _add_member(archive, member, contents, path)
            _apply_masks(contents)
            entries = contents.entries("/")
            return table_of_entries(str(path), entries, wanted, contents.left_out)
    except HystError:
        raise
    # A damaged archive fails in zipfile, zlib, struct, ast or NumPy, each with its own exception.
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no NPZ archive ({type(error).__name__}); save it again"
        ) from error


def read_npy(path: Path, wanted: Wanted) -> Table:
    """Read the array of an NPY file.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.

    Returns
    -------
    Table
        Its columns, called ``column 0`` and so on, or by the fields of a structured array.

    Raises
    ------
    InputError
        As ``read_npz``.
    """
    contents = Contents()
    try:
        with path.open("rb") as file:
            shape, dtype = _declared(file)
        if dtype.hasobject:
            raise _pickled(path, path.stem)
        array = np.load(path, mmap_mode="r", allow_pickle=False)
        if dtype.names or array.ndim < 2 or 1 in shape:
            _add_array(contents, path.stem, shape, dtype, lambda: array)
        else:
            columns = array if shape[0] >= shape[-1] else array.T
            for k in range(columns.shape[1] if columns.ndim == 2 else 0):
                contents.add(f"column {k}", columns[:, k])
        entries = contents.entries("/")
        return table_of_entries(str(path), entries, wanted, contents.left_out)
    except HystError:
        raise
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no NPY file ({type(error).__name__}); save it again"
        ) from error


def _declared(file: Any) -> tuple[tuple[int, ...], np.dtype[Any]]:
    """Read the shape and type that an array says it has, and nothing of it."""
    version = np.lib.format.read_magic(file)
    if version == (1, 0):
        shape, _, dtype = np.lib.format.read_array_header_1_0(file)
    else:
        # Version 3 differs from 2 in the letters that names of fields may have.
        shape, _, dtype = np.lib.format.read_array_header_2_0(file)
    return shape, dtype


def _add_member(archive: zipfile.ZipFile, member: str, contents: Contents, path: Path) -> None:
    name = member.removesuffix(".npy")
    with archive.open(member) as file:
        shape, dtype = _declared(file)
    if dtype.hasobject:
        raise _pickled(path, name)

    @cache
    def array() -> NDArray[Any]:
        with archive.open(member) as again:
            found: NDArray[Any] = np.lib.format.read_array(again, allow_pickle=False)
        return found

    _add_array(contents, name, shape, dtype, array)


def _add_array(
    contents: Contents,
    name: str,
    shape: tuple[int, ...],
    dtype: np.dtype[Any],
    array: Callable[[], NDArray[Any]],
) -> None:
    """Add an array, or the fields of a structured one, to be read when wanted."""
    if dtype.names:
        for field in dtype.names:
            _add_array(contents, f"{name}/{field}", shape, dtype[field], _field_of(array, field))
    elif dtype.kind == "c":
        contents.add(name, array())
    elif dtype.kind in "biuf" and not dtype.shape:
        contents.arrays[name] = Stored(shape, lambda selector: array()[selector])
        if dtype.kind == "b":
            contents.texts[name] = "mask"
    else:
        contents.left_out[name] = "holds no numbers"


def _field_of(array: Callable[[], NDArray[Any]], field: str) -> Callable[[], NDArray[Any]]:
    return lambda: array()[field]


def _apply_masks(contents: Contents) -> None:
    """Join arrays and masks that were saved side by side, as ``numpy.savez`` keeps no mask."""
    for name, stored in list(contents.arrays.items()):
        names = [pattern.format(name) for pattern in _MASK_OF]
        names += ["mask"] if name == "data" else []
        for mask in names:
            if mask in contents.texts and contents.arrays[mask].shape == stored.shape:
                masked = _masked(stored, contents.arrays[mask])
                contents.arrays[name] = Stored(stored.shape, masked, "masked")


def _masked(values: Stored, mask: Stored) -> Callable[[Selector], NDArray[Any]]:
    return lambda selector: np.ma.masked_array(values.read(selector), mask.read(selector))


def _pickled(path: Path, name: str) -> InputError:
    return InputError(
        f"{path}: the array {name!r} holds pickled Python objects, which hyst never loads; "
        "save plain arrays of numbers with numpy.savez"
    )

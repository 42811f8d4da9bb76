"""Read the data sets of an HDF5 file."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hyst.errors import HystError, InputError, MissingExtraError
from hyst.io.entries import MOST_SAMPLES, Contents, Entry, Stored, Wanted, table_of_entries
from hyst.io.hdf5_heap import has_endless_heap
from hyst.io.hdf5_values import NotAllThere, reading, stored_text
from hyst.io.mat_objects import label_signals, object_refused
from hyst.io.table import Table

SUFFIXES = (".h5", ".hdf5", ".hdf", ".nc")
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_MATLAB_NUMBERS = frozenset(
    [
        "double",
        "single",
        "logical",
        *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
    ]
)
# Where MATLAB keeps what its cells, struct arrays and objects refer to.
_KEPT = "#"
# A part of a chunk is read from here, and the chunk not unpacked again.
_CACHE = 1 << 25
_DEEPEST, _MOST_REFERENCES = 16, 100_000


def is_hdf5(path: Path) -> bool:
    """Tell whether a file is HDF5, at its start or after the 512 bytes MATLAB puts before it."""
    with path.open("rb") as file:
        start = file.read(512 + len(_SIGNATURE))
    return start.startswith(_SIGNATURE) or start[512:] == _SIGNATURE


def read_hdf5(path: Path, wanted: Wanted, separator: str = "/") -> Table:
    """Read the numeric data sets of an HDF5 file; links to other files are not followed.

    Values that the file says are missing (``_FillValue``, ``missing_value``, chunks that were
    never written) are NaN; packed numbers (``scale_factor``, ``add_offset``) are unpacked.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.
    separator
        What stands between the groups of a name: a slash, or the point of MATLAB.

    Returns
    -------
    Table
        Columns named by their full path (``group/voltage``, and ``group/table/voltage`` for a
        field of a compound type), see ``columns_of``; units from the attribute ``units`` or
        ``unit``.

    Raises
    ------
    InputError
        If the file is damaged or no HDF5 file, holds no column, or more than is allowed.
    MissingExtraError
        If h5py is not installed.
    """
    with opened_entries(path, separator) as (entries, left_out):
        return table_of_entries(str(path), entries, wanted, left_out)


@contextlib.contextmanager
def opened_entries(
    path: Path, separator: str = "/"
) -> Iterator[tuple[list[Entry], dict[str, str]]]:
    """Open an HDF5 file, give the columns it holds, and what is no column and why; close it.

    Parameters
    ----------
    path, separator
        As of ``read_hdf5``.

    Raises
    ------
    InputError
        If the file is damaged or no HDF5 file; also for what goes wrong while it is open.
    MissingExtraError
        If h5py is not installed.
    """
    try:
        import h5py
    except ImportError as error:
        raise MissingExtraError(
            f'{path}: HDF5 and MATLAB 7.3 files need h5py; pip install "hyst[files]"'
        ) from error
    if has_endless_heap(path):
        raise InputError(f"{path} is damaged (the texts in it); save it again")
    try:
        with h5py.File(path, "r", rdcc_nbytes=_CACHE) as file:
            contents = Contents()
            walk = _Walk(file, separator, contents, set())
            for name in file:
                if not name.startswith(_KEPT):
                    walk.visit(file, name, name)
            if separator == ".":
                label_signals(contents)
            entries = contents.entries(separator)
            yield entries, contents.left_out
    except HystError:
        raise
    # A damaged file fails anywhere in the HDF5 library, with any exception.
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no HDF5 file ({type(error).__name__}); save it again"
        ) from error


@dataclass(frozen=True)
class _Walk:
    """A way through a file: what has been found, and which groups have been passed."""

    file: Any
    separator: str
    contents: Contents
    passed: set[Any]

    def visit(self, group: Any, key: str, path: str, depth: int = 0) -> None:
        """Add what a name in a group stands for, unless it is a link to somewhere else."""
        import h5py

        # A soft link gives a second name to what is found anyway, or a circle.
        if isinstance(group.get(key, getlink=True), h5py.HardLink) and depth < _DEEPEST:
            self.add(group[key], path, depth)

    def add(self, item: Any, path: str, depth: int) -> None:
        """Add a data set, or all that is in a group."""
        import h5py

        kind = stored_text(item.attrs.get("MATLAB_class", b""))
        if isinstance(item, h5py.Group):
            place = h5py.h5o.get_info(item.id).addr
            if kind not in {"", "struct"}:
                self.contents.left_out[path] = object_refused(path, kind)
            elif place not in self.passed:
                self.passed.add(place)
                for key in item:
                    self.visit(item, key, f"{path}{self.separator}{key}", depth + 1)
        elif isinstance(item, h5py.Dataset) and item.shape is not None and not item.external:
            if item.dtype == h5py.ref_dtype and "MATLAB_object_decode" not in item.attrs:
                self._follow(item, path, kind, depth)
            elif kind:
                _matlab_array(item, path, kind, self.contents)
            else:
                _numbers(item, path, self.separator, self.contents)

    def _follow(self, item: Any, path: str, kind: str, depth: int) -> None:
        """Add what the references of a cell, or of a field of a struct array, point to."""
        if self.separator != ".":
            self.contents.left_out[path] = "holds references to other data sets; choose those"
            return
        if depth >= _DEEPEST or item.size > _MOST_REFERENCES:
            self.contents.left_out[path] = "holds too many cells in each other; save vectors"
            return
        parent, _, leaf = path.rpartition(".")
        for k, reference in enumerate(np.asarray(item[()]).ravel(), 1):
            if reference:
                inner = f"{path}{{{k}}}" if kind == "cell" else f"{parent}({k}).{leaf}"
                self.add(self.file[reference], inner, depth + 1)


def _matlab_array(item: Any, path: str, kind: str, contents: Contents) -> None:
    """Add an array of MATLAB, which stores its axes in the reverse order."""
    if "MATLAB_empty" in item.attrs:
        contents.left_out[path] = "is empty"
    elif kind == "char":
        if item.size < 10_000:
            contents.texts[path] = "".join(map(chr, np.asarray(item[()]).T.ravel(order="F")))
    elif kind not in _MATLAB_NUMBERS or "MATLAB_object_decode" in item.attrs:
        contents.left_out[path] = object_refused(path, kind)
    elif "MATLAB_sparse" in item.attrs:
        contents.left_out[path] = "is sparse; save full(x)"
    elif item.dtype.names == ("real", "imag"):
        if item.size > MOST_SAMPLES or np.any(item.fields("imag")[()]):
            contents.left_out[path] = "is complex; save its real part, or its magnitude"
            return
        _store(item, path, contents, ("real",), turned=True)
    else:
        _store(item, path, contents, (), turned=True)


def _numbers(item: Any, path: str, separator: str, contents: Contents) -> None:
    """Add a data set of numbers, or those of the fields of a compound type that are numbers."""
    fields = item.dtype.names or ()
    attributes = {name.casefold(): name for name in item.attrs}
    named = next((attributes[name] for name in ("units", "unit") if name in attributes), None)
    units = "" if named is None else item.attrs[named]
    each = np.asarray(units).ravel() if np.ndim(units) else None
    if not fields:
        _store(item, path, contents, ())
        contents.units[path] = _unit(units)
        return
    for k, field in enumerate(fields):
        inner = f"{path}{separator}{field}"
        kind = item.dtype[field]
        if kind.shape or kind.names:
            contents.left_out[inner] = "is an array within a row; save it as a data set"
            continue
        _store(item, inner, contents, (field,))
        if each is not None and len(each) == len(fields):
            contents.units[inner] = _unit(each[k])


def _store(
    item: Any, path: str, contents: Contents, field: tuple[str, ...], turned: bool = False
) -> None:
    try:
        read, gap = reading(item, field, turned)
    except NotAllThere as reason:
        contents.left_out[path] = str(reason)
        return
    shape = item.shape[::-1] if turned else item.shape
    contents.arrays[path] = Stored(shape, read, gap)


def _unit(value: object) -> str:
    """Give a unit as text; netCDF writes a time as ``seconds since`` some day."""
    return stored_text(value).split(" since ")[0].strip()

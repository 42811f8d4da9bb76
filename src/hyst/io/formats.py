"""Read a data file of any known format, chosen by its content and its suffix."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from hyst.checks.numbers import whole_number
from hyst.errors import InputError
from hyst.io import hdf5, mat, npz, parquet, tdms, tektronix_isf, tektronix_wfm, text, xlsx
from hyst.io.compressed import SUFFIX as GZIP_SUFFIX
from hyst.io.compressed import decompress, is_compressed
from hyst.io.entries import MOST_SAMPLES, Wanted, refuse_too_many
from hyst.io.plain_text import read_plain
from hyst.io.table import Table

_BINARY: dict[str, Callable[[Path, Wanted], Table]] = {
    "mat": mat.read_mat,
    "hdf5": hdf5.read_hdf5,
    "parquet": parquet.read_parquet,
    "tdms": tdms.read_tdms,
    "xlsx": xlsx.read_xlsx,
    "isf": tektronix_isf.read_isf,
    "wfm": tektronix_wfm.read_wfm,
    "npz": npz.read_npz,
    "npy": npz.read_npy,
}
_SUFFIXES: dict[str, str] = {
    **dict.fromkeys(text.SUFFIXES, "text"),
    **dict.fromkeys(mat.SUFFIXES, "mat"),
    **dict.fromkeys(hdf5.SUFFIXES, "hdf5"),
    **dict.fromkeys(parquet.SUFFIXES, "parquet"),
    **dict.fromkeys(tdms.SUFFIXES, "tdms"),
    **dict.fromkeys(xlsx.SUFFIXES, "xlsx"),
    **dict.fromkeys(tektronix_isf.SUFFIXES, "isf"),
    **dict.fromkeys(tektronix_wfm.SUFFIXES, "wfm"),
    ".npz": "npz",
    ".npy": "npy",
}
# How files begin whose suffix tells nothing, or says text.
_BEGINNINGS: tuple[tuple[bytes, str], ...] = (
    (b"MATLAB 5.0 MAT-file", "mat"),
    (b"MATLAB 7.3 MAT-file", "mat"),
    (b"\x89HDF\r\n\x1a\n", "hdf5"),
    (b"PAR1", "parquet"),
    (b"TDSm", "tdms"),
    (b"\x93NUMPY", "npy"),
)
_ZIP = b"PK\x03\x04"
_HEAD = 4096
FORMATS = ("text", *_BINARY)


def read_table(
    path: str | os.PathLike[str],
    *,
    columns: Sequence[int | str] | None = None,
    max_samples: int = MOST_SAMPLES,
    table: int | None = None,
    format: str | None = None,
) -> Table:
    r"""Read the columns of a data file.

    Parameters
    ----------
    path
        Text (``.csv .tsv .txt .dat .asc .tab .prn .lvm .log`` or any other name), MATLAB
        (``.mat``), HDF5 and netCDF-4 (``.h5 .hdf5 .hdf .nc``), Parquet (``.parquet .pq``), NumPy
        (``.npy .npz``), LabVIEW (``.tdms``), Excel (``.xlsx .xlsm``), Tektronix
        (``.isf .wfm``), or one of these packed (``.gz``). Where the suffix is unknown or one of
        text, the first bytes decide.
    columns
        The columns to read, as ``find_column`` takes them; by default all. Those of a binary or a
        large text file that are not wanted cost no memory and have no values in the table.
    max_samples
        Most numbers to read, all wanted columns together. What a file declares is checked before
        there is memory for it.
    table
        Which of several tables that stand below each other in a text file, from 1.
    format
        One of ``hyst.io.FORMATS``, where neither content nor suffix tells.

    Returns
    -------
    Table
        The columns with their names and units. Text and missing values are NaN; nothing in the
        file is ever executed or unpickled.

    Raises
    ------
    InputError
        If the file is missing, no regular file, empty, unreadable, damaged, holds more than is
        allowed, or several tables and ``table`` does not say which.
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
    tables = read_tables(path, columns=columns, max_samples=max_samples, format=format)
    if table is None and len(tables) == 1:
        return tables[0]
    return choose_table(tables, table)


def read_tables(
    path: str | os.PathLike[str],
    *,
    columns: Sequence[int | str] | None = None,
    max_samples: int = MOST_SAMPLES,
    format: str | None = None,
    repair: bool = False,
) -> tuple[Table, ...]:
    """Read all tables of a data file, which is one except in some text files.

    Parameters
    ----------
    path, columns, max_samples, format
        As for ``read_table``.
    repair
        Make lines of a text file that have another number of cells rows without values.

    Returns
    -------
    tuple of Table

    Raises
    ------
    InputError
        As ``read_table``, except for several tables.
    MissingExtraError
        If the format needs a package that is not installed.
    """
    wanted = Wanted(None if columns is None else tuple(columns), int(max_samples))
    with regular_file(path, format) as file:
        return _read(file, format, repair, wanted)


@contextlib.contextmanager
def regular_file(path: str | os.PathLike[str], format: str | None) -> Iterator[Path]:
    """Give the path of a file that is there, is not empty, and may be of a format.

    Raises
    ------
    InputError
        If it is not so, and for what the system refuses while the file is read.
    """
    file = Path(path)
    if format is not None and format not in FORMATS:
        raise InputError(f"format is {format!r}; give one of {', '.join(FORMATS)}")
    if not file.exists():
        raise InputError(f"{file} does not exist; check the path")
    if file.is_dir():
        raise InputError(f"{file} is a folder; name a file in it")
    if not file.is_file():
        raise InputError(f"{file} is a device or a pipe, not a regular file; save it as a file")
    try:
        if file.stat().st_size == 0:
            raise InputError(f"{file} is empty; give a file with columns of numbers")
        yield file
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise InputError(f"{file} cannot be read: {reason}; check the file") from error


def format_of(file: Path, format: str | None) -> tuple[str, bool]:
    """Tell the format of a file, and whether it is packed.

    Parameters
    ----------
    file
        Which.
    format
        What the user says; None for what content and suffix say.
    """
    with file.open("rb") as opened:
        head = opened.read(_HEAD)
    return format or _format(head, file.suffix.lower()), is_compressed(head)


def choose_table(tables: tuple[Table, ...], table: int | None) -> Table:
    """Give one of the tables of a file, or refuse and say which there are.

    Parameters
    ----------
    tables
        All of the file.
    table
        Which, from 1; None to refuse.

    Returns
    -------
    Table

    Raises
    ------
    InputError
        If there is no such table, or none is named.
    """
    if table is not None:
        return tables[whole_number(table, "table", 1, len(tables)) - 1]
    listed = "; ".join(f"{k}: {_described(each)}" for k, each in enumerate(tables[:6], 1))
    more = f"; and {len(tables) - 6} more" if len(tables) > 6 else ""
    raise InputError(
        f"{tables[0].source} holds {len(tables)} tables below each other ({listed}{more}); "
        "choose one with table"
    )


def _described(table: Table) -> str:
    rows = table.columns[0].size
    names = ", ".join(header[:20] for header in table.headers[:4])
    return f"{rows} rows from {table.place(0)} on, {names}"


def _read(file: Path, format: str | None, repair: bool, wanted: Wanted) -> tuple[Table, ...]:
    with file.open("rb") as opened:
        head = opened.read(_HEAD)
    suffix = file.suffix.lower()
    packed = is_compressed(head)
    data = decompress(file.read_bytes(), str(file)) if packed else b""
    if packed:
        head = data[:_HEAD]
        suffix = Path(file.stem).suffix.lower() if suffix == GZIP_SUFFIX else suffix
    found = format or _format(head, suffix)
    if found != "text":
        return (_unpacked(data, file, found, wanted) if packed else _BINARY[found](file, wanted),)
    data = data if packed else file.read_bytes()
    _refuse_many_lines(data, file, wanted)
    plain = read_plain(data, str(file), wanted.columns or None)
    return text.read_text(data, str(file), repair) if plain is None else (plain,)


def _refuse_many_lines(data: bytes, file: Path, wanted: Wanted) -> None:
    """Refuse more lines than allowed; a number has at least a digit and a separator."""
    columns = max(1, len(wanted.columns or ()))
    if len(data) >= 2 * wanted.most // columns:
        lines = data.count(b"\n" if b"\n" in data else b"\r")
        refuse_too_many(str(file), lines * columns, wanted.most)


def _format(head: bytes, suffix: str) -> str:
    """Tell the format by the suffix, and where that is unknown or of text by the first bytes."""
    by_suffix = _SUFFIXES.get(suffix, "text")
    if by_suffix != "text":
        return by_suffix
    if head.startswith(_ZIP):
        return "xlsx" if b"[Content_Types].xml" in head else "npz"
    return next((name for start, name in _BEGINNINGS if head.startswith(start)), "text")


def _unpacked(data: bytes, file: Path, format: str, wanted: Wanted) -> Table:
    """Read a packed file of a format whose reader wants a file."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / file.stem
        copy.write_bytes(data)
        return replace(_BINARY[format](copy, wanted), source=str(file))

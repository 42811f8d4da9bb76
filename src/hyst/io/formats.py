"""Read a data file of any known format, chosen by its content and its suffix."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from hyst.checks.numbers import whole_number
from hyst.errors import InputError
from hyst.io import hdf5, mat, npz, parquet, text
from hyst.io.compressed import SUFFIX as GZIP_SUFFIX
from hyst.io.compressed import decompress, is_compressed
from hyst.io.plain_text import Choice, read_plain
from hyst.io.table import Table

MAX_SAMPLES = 10**8

_READERS: dict[str, Callable[[Path], Table]] = {
    "mat": mat.read_mat,
    "hdf5": hdf5.read_hdf5,
    "parquet": parquet.read_parquet,
    "npz": npz.read_npz,
}
_SUFFIXES: dict[str, str] = {
    **dict.fromkeys(text.SUFFIXES, "text"),
    **dict.fromkeys(mat.SUFFIXES, "mat"),
    **dict.fromkeys(hdf5.SUFFIXES, "hdf5"),
    **dict.fromkeys(parquet.SUFFIXES, "parquet"),
    **dict.fromkeys(npz.SUFFIXES, "npz"),
}
# How files begin whatever they are called. A MAT file of version 7.3 is an HDF5 file too.
_BEGINNINGS: tuple[tuple[bytes, str], ...] = (
    (b"MATLAB 5.0 MAT-file", "mat"),
    (b"MATLAB 7.3 MAT-file", "mat"),
    (b"\x89HDF\r\n\x1a\n", "hdf5"),
    (b"PAR1", "parquet"),
    (b"PK\x03\x04", "npz"),
)
FORMATS = ("text", *_READERS)


def read_table(
    path: str | os.PathLike[str], *, table: int | None = None, format: str | None = None
) -> Table:
    r"""Read all columns of a data file.

    Parameters
    ----------
    path
        Text (``.csv .tsv .txt .dat .asc .tab .prn .lvm .log`` or any other name), MATLAB
        (``.mat``), HDF5 (``.h5 .hdf5 .hdf``), Parquet (``.parquet .pq``) or NumPy (``.npz``), or
        one of these packed (``.gz``). What a file begins with decides before its suffix.
    table
        Which of several tables that stand below each other in a text file, from 1.
    format
        ``"text"``, ``"mat"``, ``"hdf5"``, ``"parquet"`` or ``"npz"``, where neither content nor
        suffix tells.

    Returns
    -------
    Table
        The columns with their names and units. Text and missing values are NaN; nothing in the
        file is ever executed or unpickled.

    Raises
    ------
    InputError
        If the file is missing, a folder, empty, unreadable or damaged, or holds several tables
        and ``table`` does not say which.
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
    tables = read_tables(path, format=format)
    if table is None and len(tables) == 1:
        return tables[0]
    return choose_table(tables, table)


def read_tables(
    path: str | os.PathLike[str],
    *,
    format: str | None = None,
    repair: bool = False,
    max_samples: int = MAX_SAMPLES,
    columns: Choice | None = None,
) -> tuple[Table, ...]:
    """Read all tables of a data file, which is one except in some text files.

    Parameters
    ----------
    path, format
        As for ``read_table``.
    repair
        Make lines of a text file that have another number of cells rows without values.
    max_samples
        Refuse a text file of more lines.
    columns
        Chooses by headers which columns will be used; of a large text file others are NaN then.

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
    file = Path(path)
    if format is not None and format not in FORMATS:
        raise InputError(f"format is {format!r}; give one of {', '.join(FORMATS)}")
    if not file.exists():
        raise InputError(f"{file} does not exist; check the path")
    if file.is_dir():
        raise InputError(f"{file} is a folder; name a file in it")
    try:
        if file.stat().st_size == 0:
            raise InputError(f"{file} is empty; give a file with columns of numbers")
        return _read(file, format, repair, max_samples, columns)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise InputError(f"{file} cannot be read: {reason}; check the file") from error


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


def _read(
    file: Path, format: str | None, repair: bool, max_samples: int, columns: Choice | None
) -> tuple[Table, ...]:
    with file.open("rb") as opened:
        head = opened.read(64)
    suffix = file.suffix.lower()
    packed = is_compressed(head)
    data = decompress(file.read_bytes(), str(file)) if packed else b""
    if packed:
        head = data[:64]
        suffix = Path(file.stem).suffix.lower() if suffix == GZIP_SUFFIX else suffix
    found = format or recognised(head) or _SUFFIXES.get(suffix, "text")
    if found == "text":
        data = data if packed else file.read_bytes()
        lines = data.count(b"\n" if b"\n" in data else b"\r")
        if lines > max_samples:
            raise InputError(
                f"{file} has {lines} lines and max_samples is {max_samples}; give a higher "
                "max_samples, or a shorter part of the record"
            )
        plain = read_plain(data, str(file), columns)
        return text.read_text(data, str(file), repair) if plain is None else (plain,)
    return (_unpacked(data, file, found) if packed else _READERS[found](file),)


def recognised(head: bytes) -> str | None:
    """Give the format of a file by its first bytes; None where they are those of no format."""
    return next((name for beginning, name in _BEGINNINGS if head.startswith(beginning)), None)


def _unpacked(data: bytes, file: Path, format: str) -> Table:
    """Read a packed file of a format whose reader wants a file."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / file.stem
        copy.write_bytes(data)
        return replace(_READERS[format](copy), source=str(file))

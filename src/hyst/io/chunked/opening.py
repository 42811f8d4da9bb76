"""Open a record in a file, to be read in chunks."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from hyst.errors import InputError
from hyst.io.chunked.hdf5_columns import Hdf5Columns
from hyst.io.chunked.parquet_columns import ParquetColumns
from hyst.io.chunked.pieces import Columns
from hyst.io.chunked.record_file import RecordFile, version_of
from hyst.io.chunked.survey import survey
from hyst.io.chunked.text_columns import TextColumns
from hyst.io.chunked.whole_columns import WholeColumns
from hyst.io.formats import format_of, regular_file
from hyst.io.hdf5 import is_hdf5
from hyst.io.record_of_table import Wanted

_SMALL = 1 << 20


def open_record(
    path: str | os.PathLike[str],
    input: int | str,
    output: int | str,
    *,
    time: int | str | None = None,
    rate: float | None = None,
    time_unit: str | None = None,
    dead_band: float | None = None,
    format: str | None = None,
    one_way: bool = False,
) -> RecordFile:
    r"""Open a record that may be larger than the memory, and check all of it once.

    Parquet, HDF5 and netCDF-4, MATLAB 7.3, and text can be read in chunks. The checks are those of
    ``read_record``, piece by piece: missing values, text, codes of an instrument, time that falls
    or is uneven, signals that stand still, an input that does not turn. Nothing is repaired. For
    this the file is read once from end to end; the memory needed does not grow with it.

    Parameters
    ----------
    path
        The file.
    input, output
        Columns of the input and of the output, as of ``read_record``.
    time, rate, time_unit
        As of ``read_record``. Stamps must increase: clocks that start again or repeat are not
        counted on.
    dead_band
        As of ``read_record``; by default ``suggest_dead_band`` of the first 100,000 samples or so.
    format, one_way
        As of ``read_record``.

    Returns
    -------
    RecordFile
        ``chunks(samples)`` yields arrays ``u`` and ``y``, as often as it is called; ``load()``
        gives the whole ``Record``.

    Raises
    ------
    InputError
        As ``read_record``, and if the format cannot be read in chunks.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "loop.csv"
    >>> _ = path.write_text("t [ms],u [V],y [um]\n0,0,0\n5,1,3\n10,0,1\n15,1,3\n")
    >>> record = open_record(path, input="u", output="y", time="t")
    >>> len(record), record.dt, [u.tolist() for u, y in record.chunks(3)]
    (4, 0.005, [[0.0, 1.0, 0.0], [1.0]])
    """
    wanted = Wanted(input, output, time, rate, time_unit, False, dead_band, one_way=one_way)
    how: dict[str, Any] = {
        "input": input,
        "output": output,
        "time": time,
        "rate": rate,
        "time_unit": time_unit,
        "dead_band": dead_band,
        "format": format,
        "one_way": one_way,
    }
    with regular_file(path, format) as file:
        version = version_of(file)
        columns = _columns(file, format)
        return RecordFile(file, columns, survey(columns, wanted), how, version)


def reads_in_chunks(path: str | os.PathLike[str], format: str | None = None) -> bool:
    """Tell whether the format of a file is one that ``open_record`` reads.

    Parameters
    ----------
    path
        The file.
    format
        As of ``open_record``.

    Returns
    -------
    bool

    Raises
    ------
    InputError
        If there is no such file.
    """
    with regular_file(path, format) as file:
        found, packed = format_of(file, format)
        in_hdf5 = found == "mat" and not packed and is_hdf5(file)
        return not packed and (found in ("parquet", "hdf5", "text") or in_hdf5)


def _columns(file: Path, format: str | None) -> Columns:
    """Find the columns of a file of any format that can be read in chunks."""
    found, packed = format_of(file, format)
    if packed:
        raise InputError(f"{file} is packed, which cannot be read in chunks; unpack it first")
    if found == "parquet":
        return ParquetColumns.open(file)
    if found == "hdf5" or (found == "mat" and is_hdf5(file)):
        return Hdf5Columns.open(file, "/" if found == "hdf5" else ".")
    if found == "text":
        small = file.stat().st_size <= _SMALL
        return WholeColumns.open(file) if small else TextColumns.open(file)
    what = "a MATLAB file before version 7.3" if found == "mat" else f"of the format {found}"
    raise InputError(
        f"{file} is {what}, which cannot be read in chunks; save it as Parquet, HDF5 or CSV, or "
        "read it as a whole with read_record"
    )

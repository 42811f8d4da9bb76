"""Read the columns of a Parquet file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import HystError, InputError, MissingExtraError
from hyst.io.entries import Entry, Wanted, refuse_too_many, table_of_entries
from hyst.io.header import split_unit
from hyst.io.table import Table

SUFFIXES = (".parquet", ".pq")
_TICKS_PER_SECOND = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}


def read_parquet(path: Path, wanted: Wanted) -> Table:
    """Read the numeric columns of a Parquet file.

    Missing values are NaN. Dates and durations become seconds since the earliest. Columns of
    text and nested columns are left out.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.

    Returns
    -------
    Table
        The columns; units from the headers, or from the field's entry ``unit`` or ``units``.

    Raises
    ------
    InputError
        If the file is damaged or no Parquet file, holds no numeric column, or more than is
        allowed.
    MissingExtraError
        If pyarrow is not installed.
    """
    try:
        import pyarrow as arrow
        from pyarrow import compute, parquet
    except ImportError as error:
        raise MissingExtraError(
            f'{path}: Parquet files need pyarrow; pip install "hyst[files]"'
        ) from error
    try:
        with parquet.ParquetFile(path) as file:
            schema, rows = file.schema_arrow, file.metadata.num_rows
            if len(set(schema.names)) < len(schema.names):
                # Columns of one name cannot be read one by one.
                refuse_too_many(str(path), rows * len(schema), wanted.most)
                whole = file.read()
                columns = [_reading(whole, k) for k in range(len(schema))]
            else:
                columns = [_reading(file, field.name) for field in schema]
            entries, others = _entries(schema, rows, columns, arrow, compute)
            if not entries:
                raise InputError(f"{path} holds no column of numbers; save the signals as numbers")
            return table_of_entries(str(path), entries, wanted, others)
    except HystError:
        raise
    # A damaged file fails anywhere in the library, with any exception.
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no Parquet file ({type(error).__name__}); save it again"
        ) from error


def _reading(where: Any, column: str | int) -> Callable[[], Any]:
    """Read a column of a file by its name when it is asked for; or one of a table, by its place."""
    if isinstance(column, int):
        return lambda: where.column(column)
    return lambda: where.read(columns=[column]).column(0)


def _entries(
    schema: Any, rows: int, columns: Sequence[Callable[[], Any]], arrow: Any, compute: Any
) -> tuple[list[Entry], dict[str, str]]:
    entries: list[Entry] = []
    left_out: dict[str, str] = {}
    for field, column in zip(schema, columns, strict=True):
        if not _is_numeric(field.type, arrow.types):
            left_out[field.name] = f"is of the type {field.type}; save numbers"
            continue
        name, unit = split_unit(field.name)
        stated = field.metadata or {}
        said = stated.get(b"unit", stated.get(b"units", b"")).decode("utf-8", "replace")

        def read(column: Callable[[], Any] = column, kind: Any = field.type) -> Any:
            return vector_of(column(), kind, arrow, compute)

        if is_clock(field.type, arrow.types):
            unit = "s"
        entries.append(Entry(field.name, name, unit or said, rows, read))
    return entries, left_out


def is_clock(kind: Any, types: Any) -> bool:
    """Tell whether a type is that of dates or durations.

    Parameters
    ----------
    kind
        The type.
    types
        The module of arrow with tests of types.
    """
    return bool(types.is_timestamp(kind) or types.is_duration(kind))


def _is_numeric(kind: Any, types: Any) -> bool:
    tests = (
        types.is_timestamp,
        types.is_duration,
        types.is_integer,
        types.is_floating,
        types.is_boolean,
        types.is_decimal,
    )
    return any(test(kind) for test in tests)


def vector_of(
    column: Any, kind: Any, arrow: Any, compute: Any, earliest: Any = None
) -> NDArray[np.float64]:
    """Give a column as doubles, dates and durations as seconds since the earliest.

    Parameters
    ----------
    column
        Of arrow.
    kind
        Its type.
    arrow, compute
        The two modules.
    earliest
        Whole ticks from which dates count; by default the least in the column.
    """
    if is_clock(kind, arrow.types):
        ticks = column.cast(arrow.int64())
        # Subtracting whole ticks first: seconds since 1970 leave a double too few digits.
        since = compute.min(ticks) if earliest is None else arrow.scalar(earliest, arrow.int64())
        since_first = compute.subtract(ticks, since)
        return _doubles(since_first, arrow) / _TICKS_PER_SECOND[kind.unit]
    return _doubles(column, arrow)


def _doubles(column: Any, arrow: Any) -> NDArray[np.float64]:
    doubles = column.cast(arrow.float64(), safe=False)
    return np.array(doubles.to_numpy(), dtype=np.float64)

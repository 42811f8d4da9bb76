"""Read the columns of a Parquet file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, MissingExtraError
from hyst.io.header import split_unit
from hyst.io.table import Table, first_flaw

SUFFIXES = (".parquet", ".pq")
_TICKS_PER_SECOND = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}


def read_parquet(path: Path) -> Table:
    """Read all numeric columns of a Parquet file.

    Missing values are NaN. Dates and durations become seconds since the earliest. Columns of
    text and nested columns are left out.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Table
        The columns; units from the headers, or from the field's entry ``unit`` or ``units``.

    Raises
    ------
    InputError
        If the file is damaged or no Parquet file, or holds no numeric column.
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
            table = file.read()
        read = [
            (field, _vector(table.column(k), field.type, arrow, compute))
            for k, field in enumerate(table.schema)
        ]
    # A damaged file fails anywhere in the library, with any exception.
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no Parquet file ({type(error).__name__}); save it again"
        ) from error
    columns = [(field, vector) for field, vector in read if vector is not None]
    if not columns:
        raise InputError(f"{path} holds no column of numbers; save the signals as numbers")
    return _table(str(path), columns)


def _vector(column: Any, kind: Any, arrow: Any, compute: Any) -> NDArray[np.float64] | None:
    types = arrow.types
    if types.is_timestamp(kind) or types.is_duration(kind):
        ticks = column.cast(arrow.int64())
        # Subtracting whole ticks first: seconds since 1970 leave a double too few digits.
        since_first = compute.subtract(ticks, compute.min(ticks))
        return _doubles(since_first, arrow) / _TICKS_PER_SECOND[kind.unit]
    if not any(
        test(kind)
        for test in (types.is_integer, types.is_floating, types.is_boolean, types.is_decimal)
    ):
        return None
    return _doubles(column, arrow)


def _doubles(column: Any, arrow: Any) -> NDArray[np.float64]:
    doubles = column.cast(arrow.float64(), safe=False)
    return np.array(doubles.to_numpy(), dtype=np.float64)


def _table(source: str, columns: list[tuple[Any, NDArray[np.float64]]]) -> Table:
    names, units = [], []
    for field, vector in columns:
        vector.flags.writeable = False
        name, unit = split_unit(field.name)
        stated = field.metadata or {}
        names.append(name)
        units.append(
            unit or stated.get(b"unit", stated.get(b"units", b"")).decode("utf-8", "replace")
        )
    return Table(
        source=source,
        names=tuple(names),
        units=tuple(units),
        columns=tuple(vector for _, vector in columns),
        headers=tuple(field.name for field, _ in columns),
        flaws=tuple(first_flaw(vector) for _, vector in columns),
    )

"""The table of a fleet as files: CSV always, Parquet where pyarrow is installed."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

from hyst._files import replacing
from hyst.fleet.table import FleetTable

CSV, PARQUET = "fleet.csv", "fleet.parquet"

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What a spreadsheet takes a text for a formula by."""


def write_csv(table: FleetTable, path: Path) -> None:
    """Write a table as text; units stand in the headers.

    Text that a spreadsheet would run as a formula gets an apostrophe in front.

    Parameters
    ----------
    table, path
        What to write, and where: whole or not at all.
    """
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([_safe(table.header(name)) for name in table.names])
        for row in table.rows():
            writer.writerow([_cell(each) for each in row.values()])


def write_parquet(table: FleetTable, path: Path) -> bool:
    """Write a table as Parquet; say if it could be, which takes pyarrow.

    Parameters
    ----------
    table, path
        What to write, and where: whole or not at all.
    """
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError:
        return False
    fields = [
        pa.field(
            name,
            pa.string() if isinstance(table[name], tuple) else pa.float64(),
            metadata={"unit": table.units[name]} if table.units.get(name) else None,
        )
        for name in table.names
    ]
    columns = [_for_arrow(table[name]) for name in table.names]
    with replacing(path) as temporary:
        parquet.write_table(pa.table(columns, schema=pa.schema(fields)), temporary)
    return True


def _for_arrow(column: Any) -> list[Any]:
    if isinstance(column, tuple):
        return list(column)
    return [None if math.isnan(each) else each for each in column.tolist()]


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return _safe(" ".join(value.split()))
    return "" if math.isnan(value) else repr(value)


def _safe(text: str) -> str:
    return f"'{text}" if text.startswith(_FORMULA) else text

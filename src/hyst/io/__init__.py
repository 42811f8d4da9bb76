"""Data files: read text, MATLAB, HDF5, Parquet and NPZ; write text."""

from __future__ import annotations

from hyst.io.formats import FORMATS, MAX_SAMPLES, read_table, read_tables
from hyst.io.header import split_unit
from hyst.io.reading import read_column, read_record, read_records
from hyst.io.table import Table
from hyst.io.time_step import read_time_step
from hyst.io.usable_rows import LONGEST_GAP
from hyst.io.writing import join_unit, write_columns

__all__ = [
    "FORMATS",
    "LONGEST_GAP",
    "MAX_SAMPLES",
    "Table",
    "join_unit",
    "read_column",
    "read_record",
    "read_records",
    "read_table",
    "read_tables",
    "read_time_step",
    "split_unit",
    "write_columns",
]


def __dir__() -> list[str]:
    return __all__

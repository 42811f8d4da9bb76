"""Data files: read text and the files of instruments and tools; write text."""

from __future__ import annotations

from hyst.io.chunked import RecordFile, open_record
from hyst.io.driver_file import read_driver
from hyst.io.formats import FORMATS, read_table, read_tables
from hyst.io.frequency_response_file import read_frequency_response
from hyst.io.header import split_unit
from hyst.io.reading import read_column, read_record, read_records
from hyst.io.summary import ColumnSummary, FileSummary, summarize_file
from hyst.io.table import Table
from hyst.io.text_rows import read_text_rows
from hyst.io.time_step import read_time_column, read_time_step
from hyst.io.usable_rows import LONGEST_GAP
from hyst.io.writing import join_unit, write_columns

__all__ = [
    "FORMATS",
    "LONGEST_GAP",
    "ColumnSummary",
    "FileSummary",
    "RecordFile",
    "Table",
    "join_unit",
    "open_record",
    "read_column",
    "read_driver",
    "read_frequency_response",
    "read_record",
    "read_records",
    "read_table",
    "read_tables",
    "read_text_rows",
    "read_time_column",
    "read_time_step",
    "split_unit",
    "summarize_file",
    "write_columns",
]


def __dir__() -> list[str]:
    return __all__

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow
import pyarrow.parquet
import pytest

from hyst.errors import InputError
from hyst.io import read_record, read_table

# Values no decimal of a few digits can hold.
U = np.sin(np.arange(40.0)) / 3.0
Y = np.cos(np.arange(40.0)) * 1e-17


def test_parquet_keeps_every_bit_and_the_units(tmp_path: Path) -> None:
    path = tmp_path / "data.parquet"
    fields = [
        pyarrow.field("drive [V]", pyarrow.float64()),
        pyarrow.field("stroke", pyarrow.float64(), metadata={"unit": "um"}),
        pyarrow.field("note", pyarrow.string()),
        pyarrow.field("count", pyarrow.int32()),
        pyarrow.field("on", pyarrow.bool_()),
    ]
    columns = [U, Y, ["x"] * 40, np.arange(40), np.arange(40) % 2 == 0]
    table = pyarrow.table(columns, schema=pyarrow.schema(fields))
    pyarrow.parquet.write_table(table, path)
    assert read_table(path).names == ("drive", "stroke", "count", "on")
    record = read_record(path, "drive", "stroke", rate=50.0)
    assert np.array_equal(record.u, U)
    assert np.array_equal(record.y, Y)
    assert (record.input_unit, record.output_unit) == ("V", "um")


def test_a_missing_value_in_parquet_is_named_by_its_index(tmp_path: Path) -> None:
    path = tmp_path / "data.pq"
    pyarrow.parquet.write_table(pyarrow.table({"u": U, "y": [1, 2, None] + [3] * 37}), path)
    with pytest.raises(InputError, match="'y' is 'nan' at index 2"):
        read_record(path, "u", "y", rate=1.0)


def test_dates_in_parquet_are_seconds(tmp_path: Path) -> None:
    path = tmp_path / "data.parquet"
    start = np.datetime64("2024-05-01T12:00:00", "ns")
    time = start + np.arange(40) * np.timedelta64(250, "us")
    pyarrow.parquet.write_table(pyarrow.table({"time": time, "u": U, "y": Y}), path)
    assert read_record(path, "u", "y", time="time").dt == 250e-6


def test_parquet_without_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "data.parquet"
    pyarrow.parquet.write_table(pyarrow.table({"note": ["a", "b"]}), path)
    with pytest.raises(InputError, match="holds no column of numbers"):
        read_table(path)

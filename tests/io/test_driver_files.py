"""Tables of drivers in files."""

from __future__ import annotations

from pathlib import Path

import pytest

import hyst
from hyst.errors import InputError


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("code,volt\n0,-10\n10,0\n30,10\n", "V"),
        ("code;volts [mV]\n0;-10\n10;0\n30;10\n", "mV"),
        ("volt,note,Code\n-10,1,0\n0,2,10\n10,3,30\n", "V"),
        ("30 10\n10 0\n0 -10\n", "V"),
    ],
)
def test_columns_are_found_by_name_or_place(tmp_path: Path, text: str, unit: str) -> None:
    path = tmp_path / "driver.csv"
    path.write_text(text)
    driver = hyst.io.read_driver(path)
    assert driver.table_codes == (0, 10, 30)
    assert driver.table_volts == (-10.0, 0.0, 10.0)
    assert driver.unit == unit


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("code,drive\n0,1\n1,2\n", "'code' and one called 'volt'"),
        ("code,volt,volts\n0,1,1\n1,2,2\n", "'code' and one called 'volt'"),
        ("code,volt\n0,1\n1,nan\n2,3\n", "volt"),
        ("code,volt\n0,1\n1,\n2,3\n", "volt"),
        ("code,volt\n0,1\n2,3\n1,4\n", "driver.csv: row 3 .* code 1 after 2"),
        ("code,volt\n0,1\n", "driver.csv: .* has 1 rows"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "driver.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=said):
        hyst.io.read_driver(path)

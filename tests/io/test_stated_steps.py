"""Steps that a file states beside its columns, and such as may mean something else."""

from __future__ import annotations

from pathlib import Path

import pytest
from io_checks import same_signals
from lab_files import DT, rows, signals, write

from hyst.errors import InputError
from hyst.io import read_record

T, U, Y = signals()


@pytest.mark.parametrize(
    "line",
    [
        *("Sample rate: 200 samples/min", "Sample rate: 200 mHz", "Sampling period: 5 xs"),
        *("dt = 5m", "fs: 10 V", "FS: 100 um", '"Sample interval";"5,000 us"'),
        *("Sample rate: 1.25M", "Sample rate: 1000 Hz, decimation: 5", "Sample rate;1,000 Hz"),
    ],
)
def test_a_rate_that_may_mean_something_else_is_not_used(tmp_path: Path, line: str) -> None:
    path = write(tmp_path, [line, "u;y", *rows((U, Y), ";")])
    with pytest.raises(InputError, match="states no rate that is clear"):
        read_record(path, "u", "y")
    assert read_record(path, "u", "y", rate=200.0).dt == DT


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize(
    "cells",
    [
        *(("Sample Interval", "5", "ms"), ("Sample Interval", "5.0e3", "us", "x")),
        *(("Sample Rate", "0.2", "kHz"), ("Sample Rate", "200", "Trigger"), ("dt", "5 ms/pt")),
    ],
)
def test_the_unit_of_a_stated_step_in_a_cell_of_its_own(
    tmp_path: Path, cells: tuple[str, ...], separator: str
) -> None:
    lines = [separator.join(cells), "", separator.join(["u", "y", "z"])]
    path = write(tmp_path, [*lines, *rows((U, Y, U), separator)])
    record = read_record(path, "u", "y")
    # A product of two doubles.
    assert record.dt == pytest.approx(DT, rel=1e-15)
    same_signals(record, U, Y)


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize("units", ["100ns;V;um", "1e-7 s;V;um", "10 us;;mm"])
def test_a_row_of_units_with_one_that_is_not_known_is_not_left_out(
    tmp_path: Path, units: str, repair: bool
) -> None:
    # Without it the stamps would be seconds.
    path = write(tmp_path, ["time;u;y", units, *rows((5e4 * T, U, Y), ";")])
    with pytest.raises(InputError, match="at line 2, a unit in a row where"):
        read_record(path, "u", "y", time="time", repair=repair)


@pytest.mark.parametrize("missing", ["-", "NaN", "ERR", "n/a"])
def test_a_first_row_without_values_is_left_out(tmp_path: Path, missing: str) -> None:
    path = write(tmp_path, ["time;u;y", f"0;{missing};{missing}", *rows((T, U, Y), ";")[1:]])
    record = read_record(path, "u", "y", time="time", repair=True)
    same_signals(record, U[1:], Y[1:])
    assert record.samples == U.size - 1
    assert any("1 row" in each for each in record.notes), record.notes

"""Files of laboratories with the right answer, kept beside the repository."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hyst.errors import InputError
from hyst.io import read_record, read_records

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases"

pytestmark = pytest.mark.skipif(not CASES.is_dir(), reason=f"the files are not at {CASES}")

NAMED: dict[str, Any] = {"input": "voltage", "output": "displacement", "time": "time"}
NUMBERED: dict[str, Any] = {"input": 1, "output": 2, "time": 0}


@pytest.mark.parametrize(
    ("case", "how", "units", "height"),
    [
        ("appended-csv/loop.csv", NAMED | {"table": 2}, ("", ""), 63.4939),
        ("clock-stamps/loop.csv", NAMED | {"time": "Time"}, ("", ""), 63.4939),
        ("coarse-stamps/loop.csv", NAMED | {"repair": True}, ("", ""), 63.4939),
        ("footer/loop.csv", NAMED, ("", ""), 63.4939),
        ("fortran-exponent/loop.dat", NUMBERED, ("", ""), 63.4939),
        ("iso-stamps/loop.csv", NAMED | {"time": "timestamp"}, ("", ""), 63.4939),
        (
            "lvm/run.lvm",
            {"input": "Voltage", "output": "Position", "time": "X_Value"},
            ("Volts", "Volts"),
            63.4939,
        ),
        (
            "lvm-comma/run.lvm",
            {"input": "Voltage", "output": "Position", "time": "X_Value"},
            ("Volts", "Volts"),
            63.4939,
        ),
        (
            "newline-in-header/loop.csv",
            {"input": "Voltage", "output": "Disp", "time": "Time"},
            ("V", "um"),
            63.4939,
        ),
        ("scope-start-increment/scope.csv", NUMBERED, ("Volt", "Volt"), 63.494),
        (
            "scope-start-increment/scope.csv",
            {"input": "CH1", "output": "CH2", "rate": 200},
            ("Volt", "Volt"),
            63.494,
        ),
        (
            "scope-two-rows/scope.csv",
            {"input": "1", "output": "2", "time": "x-axis"},
            ("Volt", "Volt"),
            63.4939,
        ),
        ("scpi-nan/loop.csv", NAMED | {"repair": True}, ("", ""), 63.4939),
        ("scpi-overload/loop.csv", NAMED | {"repair": True}, ("", ""), 63.4939),
        ("sentinel-9999/loop.csv", NAMED | {"repair": True}, ("", ""), 63.4939),
        ("terminal-log/log.txt", NUMBERED, ("", ""), 63.4939),
        ("thousands-german/loop.csv", NUMBERED, ("V", "nm"), 6349.39),
        ("thousands-quoted/loop.csv", NUMBERED | {"repair": True}, ("V", "nm"), 6349.39),
        ("thousands-swiss/loop.csv", NUMBERED, ("V", "nm"), 6349.39),
        ("tick-wrap/log.csv", NAMED | {"time": "micros", "time_unit": "us"}, ("", ""), 63.4939),
        (
            "two-tables/meas.dat",
            {"input": "V+", "output": "P+", "time": "Time", "table": 1},
            ("V", "uC/cm2"),
            63.4939,
        ),
        ("unit-blank/loop.csv", NUMBERED, ("V", "um"), 63.494),
        ("unit-in-cells/loop.csv", NAMED, ("V", "um"), 63.4939),
        (
            "unit-spelled/loop.csv",
            {"input": "Voltage", "output": "Displacement", "time": "Time"},
            ("Volts", "microns"),
            63.4939,
        ),
        (
            "unit-underscore/loop.csv",
            {"input": "voltage_V", "output": "displacement_um", "time": "time_ms"},
            ("V", "um"),
            63.4939,
        ),
        ("units-row/loop.csv", NAMED, ("V", "um"), 63.4939),
        ("units-row-ms/loop.csv", NUMBERED, ("V", "um"), 63.4939),
        ("utf16-no-bom/loop.csv", NAMED, ("", ""), 63.4939),
    ],
)
def test_a_file_gives_the_record_that_was_measured(
    case: str, how: dict[str, Any], units: tuple[str, str], height: float
) -> None:
    record = read_record(CASES / case, **how)
    assert record.samples == 600
    assert record.dt == pytest.approx(0.005, rel=1e-12)
    assert (record.u.min(), record.u.max()) == (0.0, 100.0)
    # Printed with three to six digits.
    assert record.y.max() == pytest.approx(height, rel=1e-5)
    assert (record.input_unit, record.output_unit) == units


def test_the_second_table_has_a_rate_of_its_own() -> None:
    columns = {"input": "V+", "output": "P+", "time": "Time"}
    records = read_records(CASES / "two-tables" / "meas.dat", **columns)
    assert [each.dt for each in records] == pytest.approx([0.005, 0.0005], rel=1e-12)


def test_repeated_stamps_are_used_at_their_mean_rate() -> None:
    path = CASES / "repeated-stamps" / "loop.csv"
    with pytest.raises(InputError, match="the mean rate is 40 Hz; use it with the option repair"):
        read_record(path, "u", "y", time="t")
    assert read_record(path, "u", "y", time="t", repair=True).dt == 0.025
    assert read_record(path, "u", "y", rate=40).dt == 0.025


def test_one_whole_loop() -> None:
    record = read_record(CASES / "one-loop" / "loop.csv", **NUMBERED)
    assert (record.samples, record.dt) == (600, 0.01)


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize(
    ("case", "columns", "message"),
    [
        ("appended-csv/loop.csv", NAMED, "2 tables below each other .* 2: 600 rows from line 603"),
        (
            "own-time-columns/sdi.csv",
            {"input": "cmd", "output": "pos", "time": "time"},
            "'pos' has its own stamps in 'time_pos'",
        ),
        (
            "two-topics/bag.csv",
            {"input": "/cmd/data", "output": "/pos/data", "time": "__time"},
            "have a value together in 0 of 1200 rows only",
        ),
    ],
)
def test_a_file_that_has_two_readings_is_refused(
    case: str, columns: dict[str, Any], message: str, repair: bool
) -> None:
    with pytest.raises(InputError, match=message):
        read_record(CASES / case, **columns, repair=repair)


@pytest.mark.parametrize(
    ("case", "message"),
    [
        ("coarse-stamps/loop.csv", "coarser than the samples.* the mean rate is 200 Hz"),
        ("scpi-nan/loop.csv", r"'displacement' is 9\.91e\+37 at line 242 and in 3 rows more"),
        ("scpi-overload/loop.csv", r"'displacement' is 9\.9e\+37 at line 242"),
        ("sentinel-9999/loop.csv", "'displacement' is -9999 at line 242 and in 3 rows more"),
    ],
)
def test_a_file_that_needs_repair_is_refused_without(case: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_record(CASES / case, **NAMED)

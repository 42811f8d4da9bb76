"""Units of time and of signals, wherever above the columns or in the cells they stand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from io_checks import same_signals
from lab_files import DT, rows, signals, write

from hyst.errors import InputError
from hyst.io import read_record

T, U, Y = signals()


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize(
    ("header", "per_second"),
    [
        *(("time_ms", 1e3), ("t [ms]", 1e3), ("Timestamp us", 1e6), ("time <ms>", 1e3)),
        *(("timestamp_ns", 1e9), ("Time (msec.)", 1e3), ("Zeit in Millisekunden", 1e3)),
        *(("elapsed_seconds", 1.0), ("t/min", 1 / 60), ("time:us", 1e6), ("timeMs", 1e3)),
        *(("micros", 1e6), ("millis", 1e3), ("t_h", 1 / 3600), ("Time {s}", 1.0), ("t_s", 1.0)),
        *(("time (in µs)", 1e6), ("Time [ ms ]", 1e3), ("TIME|ms", 1e3), ("time", 1.0)),
        *(("t (microseconds)", 1e6), ("ticks_us", 1e6), ("Temps (secondes)", 1.0)),
    ],
)
def test_units_in_the_header(
    tmp_path: Path, header: str, per_second: float, separator: str
) -> None:
    body = rows((T * per_second, U, Y), separator, lambda value: f"{value:.9g}")
    path = write(tmp_path, [separator.join([header, "u", "y"]), *body])
    record = read_record(path, "u", "y", time=0)
    # Stamps are printed to nine digits.
    assert record.dt == pytest.approx(DT, rel=1e-7)
    same_signals(record, U, Y)


def test_a_unit_behind_a_comma_in_quotes(tmp_path: Path) -> None:
    path = write(tmp_path, ['"time, ms","drive, V",y', *rows((1e3 * T, U, Y))])
    record = read_record(path, "drive", "y", time="time")
    assert (record.dt, record.input_unit) == (DT, "V")


@pytest.mark.parametrize(
    ("header", "split"),
    [
        *(("voltage_mV", ("voltage", "mV")), ("disp um", ("disp", "um"))),
        *(("Weg; µm", ("Weg", "µm")), ("force N", ("force", "N")), ("u V", ("u", "V"))),
        *(("Channel A", ("Channel A", "")), ("x_in", ("x_in", "")), ("u_min", ("u_min", ""))),
        *(("V(n001)", ("V(n001)", "")), ("u_m", ("u_m", "")), ("gap width", ("gap width", ""))),
    ],
)
def test_a_unit_is_split_off_only_where_it_cannot_be_anything_else(
    tmp_path: Path, header: str, split: tuple[str, str]
) -> None:
    path = write(tmp_path, [f"t\t{header}\ty", *rows((T, U, Y), "\t")])
    record = read_record(path, header, "y", time="t")
    assert (record.input_name, record.input_unit) == split


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize(
    "top",
    [
        ["time,drive,pos", "ms,V,um"],
        ["time,drive,pos", "[ms],[V],[um]"],
        ["time,drive,pos", "msec,Volts,microns"],
        ["time,drive,pos", "(ms),(V),"],
        ["time,drive,pos", "ms,V,um", "Zeit,Antrieb,Weg"],
        ["Zeit,Antrieb,Weg", "time,drive,pos", "ms,V,um"],
        ["Rig 5", "time,drive,pos", "ms,V,um"],
        ["# rig 5", "time,drive,pos", "Millisekunden,V,-"],
    ],
)
def test_rows_of_units(tmp_path: Path, top: list[str], separator: str) -> None:
    lines = [*(line.replace(",", separator) for line in top), *rows((1e3 * T, U, Y), separator)]
    path = write(tmp_path, lines)
    for columns in (("drive", "pos", "time"), (1, 2, 0)):
        record = read_record(path, columns[0], columns[1], time=columns[2])
        assert record.dt == DT
        assert (record.input_name, record.output_name) == ("drive", "pos")
        assert record.input_unit in {"V", "Volts"}
        same_signals(record, U, Y)
    if "Zeit" in "".join(top):
        assert read_record(path, "Antrieb", "Weg", time="Zeit") == record


def test_channel_numbers_above_a_row_of_units(tmp_path: Path) -> None:
    path = write(tmp_path, ["x-axis,2,1", "second,Volt,Volt", *rows((T, U, Y))])
    record = read_record(path, "2", "1", time="x-axis")
    assert (record.dt, record.input_name, record.input_unit) == (DT, "2", "Volt")
    same_signals(record, U, Y)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            ["time_ms,u,y", "s,V,um"],
            "its header says 'ms' and the row of units 's'; give time_unit",
        ),
        (["time [s],u,y", "us,V,um"], "its header says 's' and the row of units 'us'"),
        (["timeMs,u,y", "s,V,um"], "its header says 'timeMs'|its header says 'Ms'"),
        (["time_m,u,y"], "'time_m' may be minutes or something else that is called m"),
        (["t [d],u,y"], "has the unit 'd', which is no unit of time"),
        (["Sequence,u,y", "Sequence,V,V"], "has the unit 'Sequence', which is no unit of time"),
    ],
)
def test_contradictions_and_doubts_are_refused(
    tmp_path: Path, lines: list[str], message: str
) -> None:
    path = write(tmp_path, [*lines, *rows((1e3 * T, U, Y))])
    with pytest.raises(InputError, match=message):
        read_record(path, 1, 2, time=0)
    assert read_record(path, 1, 2, time=0, time_unit="ms").dt == DT


def test_a_unit_of_a_signal_that_is_contradicted_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, ["time,u [mV],y", "s,V,um", *rows((T, U, Y))])
    with pytest.raises(InputError, match="'u': its header says 'mV' and the row of units 'V'"):
        read_record(path, "u", "y", time="time")


@pytest.mark.parametrize("start", [1.7e12, 1.7e15, 3e13])
def test_stamps_that_cannot_be_seconds_are_refused(tmp_path: Path, start: float) -> None:
    path = write(tmp_path, ["timestamp,u,y", *rows((start + 5 * np.arange(U.size), U, Y))])
    with pytest.raises(InputError, match="may be ms or us since 1970 or ns of a clock; give time"):
        read_record(path, "u", "y", time="timestamp")
    assert read_record(path, "u", "y", time="timestamp", time_unit="ms").dt == DT


@pytest.mark.parametrize(
    ("line", "per_second"),
    [
        *(("Time Unit,ms", 1e3), ("Horizontal Units: us", 1e6), ('"X Units";"ms";"Y";"V"', 1e3)),
        *(("# time unit = ns", 1e9), ("Zeiteinheit: ms", 1e3), ("Time units: s", 1.0)),
    ],
)
def test_a_unit_that_the_preamble_states(tmp_path: Path, line: str, per_second: float) -> None:
    path = write(tmp_path, [line, "t;u;y", *rows((per_second * T, U, Y), ";")])
    record = read_record(path, "u", "y", time="t")
    # Nine digits or more of every stamp were written.
    assert record.dt == pytest.approx(DT, rel=1e-7)
    assert len(record.notes) == (per_second > 1.0)
    # What is nearer to the numbers says it better.
    path = write(tmp_path, [line, "t [ms];u;y", *rows((1e3 * T, U, Y), ";")])
    assert read_record(path, "u", "y", time="t").dt == DT
    dates = [f"2025-01-01T00:00:00.{k:02d}" for k in range(U.size)]
    body = [f"{date};{row}" for date, row in zip(dates, rows((U, Y), ";"), strict=True)]
    path = write(tmp_path, [line, "time;u;y", *body])
    assert read_record(path, "u", "y", time="time").dt == pytest.approx(0.01, rel=1e-9)


@pytest.mark.parametrize("start", [45000.25, 25569.0, 739000.5])
@pytest.mark.parametrize("step", [DT, 0.25, 1.0])
def test_dates_numbered_in_days_are_refused(tmp_path: Path, start: float, step: float) -> None:
    days = start + step * np.arange(U.size) / 86400.0
    body = rows((days, U, Y), ",", lambda value: f"{value:.16g}")
    path = write(tmp_path, ["Time,u,y", *body])
    with pytest.raises(InputError, match="may be seconds, or days as spreadsheets and MATLAB"):
        read_record(path, "u", "y", time="Time")
    record = read_record(path, "u", "y", time="Time", time_unit="days")
    # Two doubles near 739000 days are 10 us apart, over 59 steps.
    assert record.dt == pytest.approx(step, abs=1e-6)
    path = write(tmp_path, ["Time [days],u,y", *body])
    assert read_record(path, "u", "y", time="Time").dt == record.dt


@pytest.mark.parametrize("step", [1e-5, 2e-5, 5e-5, 1e-3])
def test_seconds_of_a_clock_that_has_run_for_hours_are_no_days(tmp_path: Path, step: float) -> None:
    body = rows((43200.0 + step * np.arange(U.size), U, Y), ",", lambda value: f"{value:.6f}")
    path = write(tmp_path, ["Time,u,y", *body])
    # The doubles near 43200 are 7e-12 apart.
    assert read_record(path, "u", "y", time="Time").dt == pytest.approx(step, rel=1e-6)


@pytest.mark.parametrize("header", ["Sample", "Point No.", "index", "idx", "sample_number", "N"])
@pytest.mark.parametrize("first", [0, 1])
def test_numbers_of_the_samples_are_no_time(tmp_path: Path, header: str, first: int) -> None:
    count = first + np.arange(float(U.size))
    path = write(tmp_path, [f"{header},u,y", *rows((count, U, Y))])
    with pytest.raises(InputError, match="counts samples and is no time"):
        read_record(path, "u", "y", time=0)
    assert read_record(path, "u", "y", time=0, time_unit="s").dt == 1.0
    assert read_record(path, "u", "y", rate=200.0).dt == DT


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("gap", [" ", ""])
def test_units_in_the_cells(tmp_path: Path, separator: str, gap: str) -> None:
    columns = [[f"{v:.4f}{gap}{unit}" for v in x] for x, unit in ((1e3 * T, "ms"), (U, "V"))]
    path = write(tmp_path, [separator.join("tuy"), *rows((*columns, Y), separator)])
    record = read_record(path, "u", "y", time="t")
    assert (record.dt, record.input_unit, record.output_unit) == (DT, "V", "")
    same_signals(record, U, Y)


def test_units_in_the_cells_that_change_are_refused(tmp_path: Path) -> None:
    cells = [f"{v:.4f} {'mV' if k == 7 else 'V'}" for k, v in enumerate(U)]
    path = write(tmp_path, ["t,u,y", *rows((T, cells, Y))])
    with pytest.raises(InputError, match=r"'u' is '7\.0000 mV' at line 9, while others before it"):
        read_record(path, "u", "y", time="t", repair=True)


@pytest.mark.parametrize("line", ["t:{:.4f},u:{:.4f},y:{:.4f}", "t={:.4f}\tu={:.4f}\ty={:.4f}"])
def test_keys_in_the_cells(tmp_path: Path, line: str) -> None:
    path = write(tmp_path, [line.format(*each) for each in zip(T, U, Y, strict=True)])
    record = read_record(path, "u", "y", time="t")
    assert record.dt == DT
    same_signals(record, U, Y)

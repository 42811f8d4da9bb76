"""Repair leaves out little and says what; codes of instruments are no measurements."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from io_checks import same_signals
from lab_files import DT, rows, signals, write

from hyst.errors import InputError
from hyst.io import read_column, read_record

T, U, Y = signals(200)


def with_cells(
    folder: Path, cells: dict[int, str], column: str = "y", separator: str = ","
) -> Path:
    written = {"t": [f"{v:.4f}" for v in T], "u": [f"{v:.4f}" for v in U]}
    written["y"] = [f"{v:.4f}" for v in Y]
    for row, text in cells.items():
        written[column][row] = text
    body = rows(tuple(written.values()), separator)
    return write(folder, [separator.join(["time", "u", "y"]), *body])


def without(values: np.ndarray, gone: list[int]) -> np.ndarray:
    """What a straight line over the gaps gives."""
    kept = np.delete(np.arange(values.size), gone)
    return np.interp(np.arange(values.size), kept, values[kept])


@pytest.mark.parametrize(
    ("code", "places"),
    [
        *(("9.91E+37", [50, 51, 90]), ("9.9E+37", [50]), ("-9.9e37", [7, 70]), ("-9999", [50, 90])),
        *(("9999", [80]), ("-999.25", [20, 21, 22]), ("99999.0", [3, 150]), ("1e20", [100])),
        *(("65535", [33]), ("-32768", [60, 61]), ("3.4028235e38", [5]), ("-1234.5", [10, 40])),
    ],
)
@pytest.mark.parametrize("column", ["u", "y"])
def test_codes_of_instruments(tmp_path: Path, code: str, places: list[int], column: str) -> None:
    path = with_cells(tmp_path, dict.fromkeys(places, code), column)
    message = rf"'{column}' is {float(code):.6g} at line {places[0] + 2}"
    with pytest.raises(InputError, match=message.replace("+", r"\+") + ".* with the option repair"):
        read_record(path, "u", "y", time="time")
    record = read_record(path, "u", "y", time="time", repair=True)
    assert record.dt == DT
    assert np.allclose(record.u, without(U, places), rtol=0.0, atol=1e-12)
    assert np.allclose(record.y, without(Y, places), rtol=0.0, atol=1e-12)
    assert record.notes[0].startswith(f"left out {len(places)} row")
    assert f"'{column}' is {float(code):.6g}, a code" in record.notes[0]


@pytest.mark.parametrize(
    "y",
    [
        1e3 * Y - 9999.0,  # passes -9999 like any other value
        np.where(np.arange(200) % 20 < 10, 9999.0, Y),  # half the record
        np.where((np.arange(200) >= 60) & (np.arange(200) < 90), 80.0, Y),  # a level that is held
        np.where(np.arange(200) == 77, 8.0 * Y.max(), Y),  # a single spike is judged elsewhere
        np.clip(Y, None, 4.0),  # a sensor at its end
        1e30 * Y,
    ],
)
def test_what_is_measured_is_no_code(tmp_path: Path, y: np.ndarray) -> None:
    body = rows((T, U, y), write=lambda v: f"{v:.9g}")
    path = write(tmp_path, ["time,u,y", *body])
    record = read_record(path, "u", "y", time="time")
    assert np.allclose(record.y, y, rtol=1e-8)
    assert record.notes == ()


@pytest.mark.parametrize("share", [0.1, 0.4, 0.8])
def test_many_codes_are_refused_and_not_read(tmp_path: Path, share: float) -> None:
    places = np.sort(np.random.default_rng(1).choice(200, int(200 * share), replace=False))
    path = with_cells(tmp_path, dict.fromkeys(places.tolist(), "9.91E+37"))
    named = rf"'y' is 9.91e\+37 at line {places[0] + 2} and in {places.size - 1} rows more"
    with pytest.raises(InputError, match=named) as refused:
        read_record(path, "u", "y", time="time")
    assert "option repair" not in str(refused.value)
    with pytest.raises(InputError, match=f"{places.size} of 200 rows hold no value"):
        read_record(path, "u", "y", time="time", repair=True)


@pytest.mark.parametrize("height", [20.0, 50.0])
def test_answers_to_pulses_of_the_input_are_no_codes(tmp_path: Path, height: float) -> None:
    u = 0.01 * U
    u[[30, 31, 120, 121]] = height
    path = write(tmp_path, ["time,u,y", *rows((T, u, 2.0 * u + 1.0))])
    with pytest.raises(InputError, match=f"'u' is {height:.0f} at line 32"):
        read_record(path, "u", "y", time="time")
    dense = np.where(np.arange(200) % 40 < 4, height, 0.01 * U)  # a tenth of all: a drive
    path = write(tmp_path, ["time,u,y", *rows((T, dense, 2.0 * dense + 1.0))])
    assert read_record(path, "u", "y", time="time").notes == ()


def test_a_wanted_trajectory_has_peaks_but_no_codes(tmp_path: Path) -> None:
    for code in ("9.9E37", "-9999", "32767"):
        path = with_cells(tmp_path, {60: code})
        with pytest.raises(InputError, match=r"'y' is .* at line 62, .* a code of the instrument"):
            read_column(path, "y")
    path = with_cells(tmp_path, {60: "2500.5"})
    assert read_column(path, "y")[0][60] == 2500.5


@pytest.mark.parametrize("text", ["", "nan", "err", "#N/A", "---"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_few_bad_cells(tmp_path: Path, text: str, separator: str) -> None:
    gone = [20, 21, 60, 150]
    path = with_cells(tmp_path, dict.fromkeys(gone, text), separator=separator)
    with pytest.raises(InputError, match=r"'y' .* at line 22.*or leave such rows out with the opt"):
        read_record(path, "u", "y", time="time")
    for how in ({"time": "time"}, {"rate": 200.0}):
        record = read_record(path, "u", "y", repair=True, **how)  # type: ignore[arg-type]
        assert record.dt == DT
        assert np.allclose(record.y, without(Y, gone), rtol=0.0, atol=1e-12)
        assert record.notes[0] == "left out 4 rows that held no number or no finite one"


@pytest.mark.parametrize(
    ("gone", "message"),
    [
        (list(range(0, 200, 10)), r"20 of 200 rows hold no value .* repair leaves out 10 at most"),
        (list(range(20, 26)), r"6 rows in a row hold no value after line 21, and repair bridges 5"),
        (list(range(100, 200)), r"100 of 200 rows hold no value"),
    ],
)
def test_much_is_not_repaired(tmp_path: Path, gone: list[int], message: str) -> None:
    path = with_cells(tmp_path, dict.fromkeys(gone, "err"))
    with pytest.raises(InputError, match=message):
        read_record(path, "u", "y", time="time", repair=True)
    with pytest.raises(InputError, match="'y' is 'err' at line") as refused:
        read_record(path, "u", "y", time="time")
    # Repair is advised only where it would do.
    assert ("with the option repair" in str(refused.value)) == (len(gone) <= 10)
    if len(gone) == 6:
        assert read_record(path, "u", "y", time="time", repair=True, longest_gap=6).samples == 200


def test_repair_is_never_advised_where_a_column_cannot_be_read(tmp_path: Path) -> None:
    for text in ("1.234,5x", "high", "0x1F"):
        path = with_cells(tmp_path, dict.fromkeys(range(200), text), separator=";")
        with pytest.raises(InputError, match="200 of 200 rows lack a value, too many to leave out"):
            read_record(path, "u", "y", time="time")
        with pytest.raises(InputError, match=r"'y' is .* at line 2"):
            read_record(path, "u", "y", time="time", repair=True)


@pytest.mark.parametrize("lost", [1, 5, 6, 50])
def test_lost_samples_are_filled_in_where_they_are_few(tmp_path: Path, lost: int) -> None:
    gone = list(range(70, 70 + lost))
    body = rows((np.delete(T, gone), np.delete(U, gone), np.delete(Y, gone)))
    path = write(tmp_path, ["time,u,y", *body])
    with pytest.raises(InputError, match="time is uneven") as refused:
        read_record(path, "u", "y", time="time")
    assert ("with the option repair" in str(refused.value)) == (lost <= 5)
    if lost > 5:
        with pytest.raises(InputError, match=rf"{lost} samples are missing.* fills in 5 at most"):
            read_record(path, "u", "y", time="time", repair=True)
        return
    record = read_record(path, "u", "y", time="time", repair=True)
    assert np.allclose(record.y, without(Y, gone), rtol=0.0, atol=1e-10)
    told = f"resampled linearly onto steps of 0.005 s, {lost} of 200 samples filled in"
    assert told in record.notes[0]


@pytest.mark.parametrize("name", ["time_pos", "t", "X_Value", "pos.time"])
def test_a_signal_with_stamps_of_its_own(tmp_path: Path, name: str) -> None:
    half = [[f"{v:.4f}" for v in x[::2]] + [""] * 100 for x in (T, Y)]
    path = write(tmp_path, [f"time,cmd,{name},pos", *rows((T, U, *half))])
    for repair in (False, True):
        with pytest.raises(InputError, match=f"'pos' has its own stamps in '{name}'"):
            read_record(path, "cmd", "pos", time="time", repair=repair)
    late = rows((T, U, T + 0.6 * DT, Y))
    path = write(tmp_path, [f"time,cmd,{name},pos", *late])
    with pytest.raises(InputError, match=rf"'pos' has its own stamps in '{name}'"):
        read_record(path, "cmd", "pos", time="time")
    scanned = rows((T, U, T + 1e-4, Y))
    path = write(tmp_path, [f"time,cmd,{name},pos", *scanned])
    same_signals(read_record(path, "cmd", "pos", time="time"), U, Y)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_signals_that_never_share_a_row(tmp_path: Path, separator: str) -> None:
    lines = [separator.join(["time", "u", "y"])]
    for t, u, y in zip(T, U, Y, strict=True):
        lines += [f"{t:.4f},{u:.4f},", f"{t + 0.002:.4f},,{y:.4f}"]
    path = write(tmp_path, [line.replace(",", separator) for line in lines])
    for repair in (False, True):
        with pytest.raises(InputError, match="'u' and 'y' have a value together in 0 of 400 rows"):
            read_record(path, "u", "y", time="time", repair=repair)


@pytest.mark.parametrize(
    "u",
    [
        np.r_[np.linspace(0, 100, 50), np.linspace(100, 0, 51)[1:]],
        np.r_[np.linspace(3, -7, 60), np.linspace(-7, 2, 41)[1:]],
        np.r_[np.linspace(0, 1, 50), np.linspace(1, 0.4, 51)[1:]],
    ],
)
def test_one_whole_loop_is_enough(tmp_path: Path, u: np.ndarray) -> None:
    path = write(tmp_path, ["u,y", *rows((u, 2 * u + 1))])
    assert read_record(path, "u", "y", rate=10.0).samples == 100


@pytest.mark.parametrize(
    "u", [np.linspace(0, 1, 100), np.r_[np.linspace(0, 1, 80), np.linspace(1, 0.8, 21)[1:]]]
)
def test_half_a_loop_is_not(tmp_path: Path, u: np.ndarray) -> None:
    path = write(tmp_path, ["u,y", *rows((u, 2 * u + 1))])
    with pytest.raises(InputError, match="or one rise and fall of about the same size"):
        read_record(path, "u", "y", rate=10.0, dead_band=0.05)

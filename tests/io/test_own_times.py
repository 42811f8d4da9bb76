"""Two signals stamped apart: found out, and brought to one raster with an error that is told."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import h5py
import numpy as np
import pytest

from hyst.errors import InputError
from hyst.io import read_record

DT = 0.005
SAMPLES = 600


def input_at(time: np.ndarray) -> np.ndarray:
    """A smooth drive whose values at any instant are known."""
    return 50.0 - 50.0 * np.cos(2.0 * np.pi * 1.5 * time)


def triangle_at(time: np.ndarray) -> np.ndarray:
    """A drive with corners."""
    return 200.0 * np.abs((0.7 * time + 0.31) % 1.0 - 0.5)


def output_at(time: np.ndarray) -> np.ndarray:
    return 0.6 * input_at(time - 0.021) + 3.0 * np.sin(7.0 * time)


def cell(value: float) -> str:
    return "" if np.isnan(value) else repr(float(value))


def written(folder: Path, header: str, columns: Sequence[np.ndarray], separator: str = ",") -> Path:
    longest = max(column.size for column in columns)
    rows = [header]
    for k in range(longest):
        rows.append(
            separator.join(cell(column[k]) if k < column.size else "" for column in columns)
        )
    path = folder / "log.csv"
    path.write_text("\n".join(rows) + "\n")
    return path


def costs(notes: Sequence[str]) -> list[float]:
    return [float(re.findall(r"up to about (\S+)", note)[0]) for note in notes if "costs" in note]


# Columns of time for each signal


@pytest.mark.parametrize("header", ["time,cmd,time_pos,pos", "t,cmd,pos time,pos", "t,cmd,t2,pos"])
@pytest.mark.parametrize("separator", [",", ";"])
def test_a_signal_with_its_own_stamps_is_not_paired_with_others(
    tmp_path: Path, header: str, separator: str
) -> None:
    fast, slow = DT * np.arange(SAMPLES), 2.0 * DT * np.arange(SAMPLES // 2)
    columns = (fast, input_at(fast), slow, output_at(slow))
    path = written(tmp_path, header.replace(",", separator), columns, separator)
    for repair in (False, True):
        with pytest.raises(InputError, match=r"'pos' has its own stamps in .*output_time and resa"):
            read_record(path, "cmd", "pos", time=0, repair=repair)
    record = read_record(path, "cmd", "pos", time=0, output_time=2, resample=True)
    assert (record.samples, record.dt) == (SAMPLES // 2, 2.0 * DT)
    # Every stamp of the output is one of the input: nothing is interpolated, sums aside.
    assert np.abs(record.u - input_at(slow)).max() <= 1e-9
    assert np.array_equal(record.y, output_at(slow))
    assert "a sample at each of them" in " ".join(record.notes)


def test_the_slower_signal_gives_the_raster_also_if_it_is_the_input(tmp_path: Path) -> None:
    slow, fast = 0.013 * np.arange(230), 0.1 + 0.001 * np.arange(2900)
    path = written(tmp_path, "t_u,u [V],t_y,y", (slow, input_at(slow), fast, output_at(fast)))
    record = read_record(path, "u", "y", input_time="t_u", output_time="t_y", resample=True)
    kept = slow[(slow >= fast[0]) & (slow <= fast[-1])]
    assert (record.samples, record.dt) == (kept.size, 0.013)
    assert np.array_equal(record.u, input_at(kept))
    # A step of 1 ms: h^2/8 times the second derivative of the output.
    assert np.abs(record.y - output_at(kept)).max() <= 1e-6 / 8.0 * (30.0 * 9.5**2 + 3.0 * 49.0)
    assert f"left out {230 - kept.size} of 230 samples of 'u'" in " ".join(record.notes)


@pytest.mark.parametrize("scale", [1.0, 1000.0])
def test_stamps_in_other_units_are_brought_together(tmp_path: Path, scale: float) -> None:
    unit = {1.0: "s", 1000.0: "ms"}[scale]
    fast, slow = DT * np.arange(SAMPLES), 2.0 * DT * np.arange(SAMPLES // 2)
    header = f"t_u [s],u,t_y [{unit}],y"
    path = written(tmp_path, header, (fast, input_at(fast), scale * slow, output_at(slow)))
    record = read_record(path, "u", "y", input_time="t_u", output_time="t_y", resample=True)
    assert record.dt == 2.0 * DT
    assert np.abs(record.u - input_at(slow)).max() <= 1e-9  # rounding of stamps times 500 V/s


def test_a_second_time_column_that_says_the_same_is_no_reason(tmp_path: Path) -> None:
    time = DT * np.arange(SAMPLES)
    columns = (time, input_at(time), time + 1.7e9, output_at(time))
    path = written(tmp_path, "time,cmd,time_pos,pos", columns)
    assert read_record(path, "cmd", "pos", time="time").samples == SAMPLES


def test_own_stamps_in_another_group_are_found(tmp_path: Path) -> None:
    path = tmp_path / "log.h5"
    fast, late = DT * np.arange(SAMPLES), DT * (1.1 * np.arange(SAMPLES))
    with h5py.File(path, "w") as file:
        file["a/time"], file["a/u"] = fast, input_at(fast)
        file["b/time"], file["b/y"] = late, output_at(late)
    with pytest.raises(InputError, match="'b/y' has its own stamps in 'b/time'"):
        read_record(path, "a/u", "b/y", time="a/time")
    record = read_record(path, "a/u", "b/y", time="a/time", output_time="b/time", resample=True)
    assert record.dt == pytest.approx(1.1 * DT, rel=1e-12)  # 12 digits are kept
    # h^2/8 times the second derivative of the input.
    bound = DT**2 / 8.0 * 50.0 * (3.0 * np.pi) ** 2
    inside = np.abs(record.u - input_at(late[: record.samples]))[:-1]  # the last one is held
    assert inside.max() <= bound * 1.001


# One column of time, cells empty where the other signal ticked


def topics(folder: Path, shift: float, step: float = DT, signal=input_at) -> Path:  # type: ignore[no-untyped-def]
    first, second = step * np.arange(SAMPLES), step * np.arange(SAMPLES) + shift
    time = np.concatenate([first, second])
    u = np.concatenate([signal(first), np.full(SAMPLES, np.nan)])
    y = np.concatenate([np.full(SAMPLES, np.nan), output_at(second)])
    order = np.argsort(time, kind="stable")
    return written(folder, "__time,/cmd,/pos", (time[order], u[order], y[order]))


@pytest.mark.parametrize("shift", [0.002, 0.004, 0.0001])
def test_signals_that_ticked_apart_are_brought_to_the_stamps_of_the_output(
    tmp_path: Path, shift: float
) -> None:
    path = topics(tmp_path, shift)
    for repair in (False, True):
        with pytest.raises(InputError, match=r"a value together in 0 of 1200 rows only.*resample"):
            read_record(path, "/cmd", "/pos", time="__time", repair=repair)
    record = read_record(path, "/cmd", "/pos", time="__time", resample=True)
    assert (record.samples, record.dt) == (SAMPLES, DT)
    stamps = DT * np.arange(SAMPLES) + shift
    assert np.array_equal(record.y, output_at(stamps))
    # Between samples h^2/8 times the second derivative; the last one is held.
    inside = np.abs(record.u - input_at(stamps))[:-1].max()
    assert inside <= DT**2 / 8.0 * 50.0 * (3.0 * np.pi) ** 2
    assert record.u[-1] == input_at(DT * np.arange(SAMPLES))[-1]
    assert "its last value held at 1" in " ".join(record.notes)


@pytest.mark.parametrize("signal", [input_at, triangle_at])
@pytest.mark.parametrize("shift", [0.13, 0.5, 0.77])
@pytest.mark.parametrize("step", [0.005, 0.02])
def test_the_error_told_is_about_the_error_made(  # type: ignore[no-untyped-def]
    tmp_path: Path, signal, shift: float, step: float
) -> None:
    path = topics(tmp_path, shift * step, step, signal)
    record = read_record(path, "/cmd", "/pos", time="__time", resample=True)
    stamps = step * np.arange(SAMPLES) + shift * step
    made = np.abs(record.u - signal(stamps)).max()
    (told,) = costs(record.notes)
    # Never less, but for curvature that changes between samples and the 3 digits it is told with;
    # at a corner it is the error, where a signal is smooth four times the error.
    assert 0.97 * made <= told <= 4.5 * made


@pytest.mark.parametrize("shift", [0.002, 0.0001, 0.0])
def test_an_input_that_is_held_keeps_its_values(tmp_path: Path, shift: float) -> None:
    path = topics(tmp_path, shift)
    time = DT * np.arange(SAMPLES)
    linear = read_record(path, "/cmd", "/pos", time="__time", resample=True) if shift else None
    if linear is not None:
        assert "held until its next stamp, give hold_input" in " ".join(linear.notes)
    else:
        columns = (time, input_at(time), time, output_at(time))
        path = written(tmp_path, "__time,/cmd,t_y,/pos", columns)
    clock = None if shift else "t_y"
    record = read_record(
        path, "/cmd", "/pos", time="__time", output_time=clock, resample=True, hold_input=True
    )
    # Every output lies after the input of the same number and before the next one.
    assert np.array_equal(record.u, input_at(time))
    assert not costs(record.notes)


def test_holding_without_resampling_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="hold_input says how to resample"):
        read_record(topics(tmp_path, 0.002), 1, 2, time=0, hold_input=True)


def test_scaled_by_a_power_of_two_nothing_else_changes(tmp_path: Path) -> None:
    (tmp_path / "scaled").mkdir()
    plain = read_record(topics(tmp_path, 0.002), "/cmd", "/pos", time="__time", resample=True)
    path = topics(tmp_path / "scaled", 0.002, signal=lambda t: 2.0**-20 * input_at(t))
    scaled = read_record(path, "/cmd", "/pos", time="__time", resample=True)
    assert np.array_equal(scaled.u, 2.0**-20 * plain.u)


# Refusals


def test_a_hole_is_not_filled(tmp_path: Path) -> None:
    time = DT * np.arange(SAMPLES)
    cut = np.delete(time, slice(300, 340))
    path = written(tmp_path, "t_u,u,t_y,y", (cut, input_at(cut), time, output_at(time)))
    with pytest.raises(InputError, match=r"'u' has no value for 0\.205 s after 1\.495 s"):
        read_record(path, "u", "y", input_time="t_u", output_time="t_y", resample=True)


@pytest.mark.parametrize(("code", "column"), [("9.9E37", 1), ("-9999", 3), ("1e30", 3)])
def test_codes_of_signals_stamped_apart_are_no_measurements(
    tmp_path: Path, code: str, column: int
) -> None:
    fast, slow = DT * np.arange(SAMPLES), 2.0 * DT * np.arange(SAMPLES // 2)
    path = written(tmp_path, "t_u,u,t_y,y", [fast, input_at(fast), slow, output_at(slow)])
    clean = read_record(path, "u", "y", input_time="t_u", output_time="t_y", resample=True)
    lines = path.read_text().splitlines()
    for row in (50, 51, 120):
        cells = lines[row].split(",")
        cells[column] = code
        lines[row] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n")
    how = {"input_time": "t_u", "output_time": "t_y", "resample": True}
    name = "u" if column == 1 else "y"
    named = re.escape(f"'{name}' is {float(code):g} at line 51 and in 2 rows more")
    with pytest.raises(InputError, match=named):
        read_record(path, "u", "y", **how)  # type: ignore[arg-type]
    record = read_record(path, "u", "y", **how, repair=True)  # type: ignore[arg-type]
    assert any(note.startswith("left out 3 rows where") for note in record.notes)
    # A straight line over at most 3 steps of the slower signal, whose bend is at most 750 /s^2.
    step = clean.dt if name == "y" else DT
    assert np.abs(record.u - clean.u).max() <= 4444.0 * (3 * step) ** 2 / 8
    assert np.abs(record.y[: clean.y.size] - clean.y[: record.y.size]).max() <= (
        2900.0 * (3 * clean.dt) ** 2 / 8
    )


@pytest.mark.parametrize("name", ["time_ms", "Timestamp (ms)", "timeMs", "t / ms"])
def test_units_of_stamps_are_found_alike(tmp_path: Path, name: str) -> None:
    time = DT * np.arange(SAMPLES)
    columns = [1e3 * time, input_at(time), 1e3 * (time + 0.002), output_at(time + 0.002)]
    path = written(tmp_path, f"{name},u,{name} y,y", columns)
    record = read_record(path, "u", "y", input_time=0, output_time=2, time_unit="ms", resample=True)
    path = written(tmp_path, f"{name},u,other,y", [*columns[:2], columns[0], columns[3]])
    plain = read_record(path, "u", "y", time=0, resample=True)
    assert record.dt == plain.dt == DT


def test_signals_that_never_overlap_are_refused(tmp_path: Path) -> None:
    time = DT * np.arange(SAMPLES)
    path = written(tmp_path, "t_u,u,t_y,y", (time, input_at(time), time + 60.0, output_at(time)))
    with pytest.raises(InputError, match="samples in common; check the stamps and their units"):
        read_record(path, "u", "y", input_time="t_u", output_time="t_y", resample=True)


def test_different_stamps_are_not_read_as_one_without_asking(tmp_path: Path) -> None:
    time = DT * np.arange(SAMPLES)
    columns = (time, input_at(time), time + 0.4 * DT, output_at(time + 0.4 * DT))
    path = written(tmp_path, "t_u,u,t_y,y", columns)
    with pytest.raises(InputError, match=r"up to 0\.002 s apart; the option resample"):
        read_record(path, "u", "y", input_time="t_u", output_time="t_y")
    with pytest.raises(InputError, match="a rate is given with stamps"):
        read_record(path, "u", "y", rate=200, output_time="t_y")
    with pytest.raises(InputError, match="a signal has no stamps; give time, or"):
        read_record(path, "u", "y", output_time="t_y", resample=True)
    with pytest.raises(InputError, match="cannot be its own time"):
        read_record(path, "u", "y", time="t_u", output_time="y", resample=True)


def test_stamps_that_go_back_and_text_are_named(tmp_path: Path) -> None:
    time = DT * np.arange(SAMPLES)
    back = time.copy()
    back[100] = back[98]
    path = written(tmp_path, "t_u,u,t_y,y", (time, input_at(time), back, output_at(time)))
    with pytest.raises(InputError, match=r"the time 't_y' of 'y' does not increase at line 102"):
        read_record(path, "u", "y", input_time="t_u", output_time="t_y", resample=True)
    path.write_text(path.read_text().replace(repr(float(output_at(time)[50])), "error"))
    with pytest.raises(InputError, match="'y' is 'error' at line 52"):
        read_record(path, "u", "y", time="t_u", resample=True)

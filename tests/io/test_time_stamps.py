"""Stamps as people and clocks write them: dates, coarse, rounded, jittering and full counters."""

from __future__ import annotations

import datetime
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from io_checks import same_signals
from lab_files import DT, rows, signals, write

from hyst.errors import InputError
from hyst.io import read_column, read_record, read_records

T, U, Y = signals()
START = datetime.datetime(2026, 11, 28, 23, 59, 59, 900_000)
MOMENTS = [START + datetime.timedelta(seconds=float(t)) for t in T]


def milliseconds(form: str) -> Callable[[datetime.datetime], str]:
    """Python writes microseconds; loggers write three digits."""
    return lambda moment: moment.strftime(form).replace("%", f"{moment.microsecond // 1000:03d}")


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
@pytest.mark.parametrize(
    "form",
    [
        *("%Y-%m-%dT%H:%M:%S.%%", "%Y-%m-%dT%H:%M:%S.%%Z", "%Y-%m-%dT%H:%M:%S.%%+01:00"),
        *("%Y-%m-%d %H:%M:%S.%%", "%Y/%m/%d %H:%M:%S.%%", "%d.%m.%Y %H:%M:%S.%%"),
        *("%m/%d/%Y %I:%M:%S.%% %p", "%d-%b-%Y %H:%M:%S.%%", "%H:%M:%S.%%", "%H:%M:%S:%%"),
    ],
)
def test_dates_and_times_of_day(tmp_path: Path, form: str, separator: str) -> None:
    if separator == " " and form.count(" ") + form.count("-%b") > 1:
        pytest.skip("white space between columns and in them")
    stamps = [milliseconds(form)(moment) for moment in MOMENTS]
    if separator == " " and "%b" in form:
        pytest.skip("white space between columns and in them")
    path = write(tmp_path, [separator.join(["stamp", "u", "y"]), *rows((stamps, U, Y), separator)])
    record = read_record(path, "u", "y", time="stamp")
    assert record.dt == DT
    same_signals(record, U, Y)
    midnight = [note for note in record.notes if "passes midnight 1 times" in note]
    assert bool(midnight) == form.startswith("%H")


def test_decimal_commas_in_stamps(tmp_path: Path) -> None:
    stamps = [milliseconds("%d.%m.%Y %H:%M:%S,%%")(moment) for moment in MOMENTS]
    path = write(tmp_path, [r.replace(".5", ",5") for r in rows((stamps, U, Y), ";")])
    lines = [f"{s};{u:.4f};{y:.4f}".split(";") for s, u, y in zip(stamps, U, Y, strict=True)]
    text = [";".join([s, u.replace(".", ","), y.replace(".", ",")]) for s, u, y in lines]
    path = write(tmp_path, ["Zeit;u;y", *text])
    record = read_record(path, "u", "y", time="Zeit")
    assert record.dt == DT
    same_signals(record, U, Y)


@pytest.mark.parametrize("separator", [",", "\t"])
@pytest.mark.parametrize("order", [("date", "clock"), ("clock", "date")])
def test_a_date_and_a_clock_in_two_columns(
    tmp_path: Path, separator: str, order: tuple[str, str]
) -> None:
    parts = {
        "date": [moment.strftime("%Y-%m-%d") for moment in MOMENTS],
        "clock": [milliseconds("%H:%M:%S.%%")(moment) for moment in MOMENTS],
    }
    body = rows((*(parts[each] for each in order), U, Y), separator)
    path = write(tmp_path, [separator.join([*order, "u", "y"]), *body])
    for column in order:
        assert read_record(path, "u", "y", time=column).dt == DT


def test_minutes_and_seconds(tmp_path: Path) -> None:
    stamps = [f"{int(t + 59.9) // 60:02d}:{(t + 59.9) % 60:06.3f}" for t in T]
    path = write(tmp_path, ["t,u,y", *rows((stamps, U, Y))])
    assert read_record(path, "u", "y", time="t").dt == DT
    # Nothing but a number above 23 tells minutes from hours.
    for first, dt in ((22, None), (24, 1.0)):
        stamps = [f"{first + k // 60:02d}:{k % 60:02d}" for k in range(T.size)]
        path = write(tmp_path, ["t,u,y", *rows((stamps, U, Y))])
        if dt is None:
            with pytest.raises(InputError, match="may be hours and minutes or minutes and secon"):
                read_record(path, "u", "y", time="t")
        else:
            assert read_record(path, "u", "y", time="t").dt == dt


def test_days_and_months_that_cannot_be_told_apart_are_refused(tmp_path: Path) -> None:
    days = [f"0{1 + k // 30}/05/2026 12:00:00.{k:03d}" for k in range(60)]
    path = write(tmp_path, ["t,u,y", *rows((days, U, Y))])
    with pytest.raises(InputError, match="may be day/month or month/day, and the dates of the"):
        read_record(path, "u", "y", time="t")
    # A single date changes nothing, whichever it is.
    one = [day.replace("02/05", "01/05") for day in days]
    path = write(tmp_path, ["t,u,y", *rows((one, U, Y))])
    assert read_record(path, "u", "y", time="t").dt == 0.001


def test_a_stamp_that_is_none_is_named(tmp_path: Path) -> None:
    stamps = [milliseconds("%H:%M:%S.%%")(moment) for moment in MOMENTS]
    stamps[30] = "12:0x:00.000"
    path = write(tmp_path, ["t,u,y", *rows((stamps, U, Y))])
    with pytest.raises(InputError, match=r"'t' is '12:0x:00\.000' at line 32"):
        read_record(path, "u", "y", time="t")


@pytest.mark.parametrize(
    ("clock", "unit"), [(2 * DT, 1.0), (5 * DT, 1.0), (1.5 * DT, 1e3), (7 * DT, 1e6)]
)
@pytest.mark.parametrize("phase", [0.0, 0.3])
def test_stamps_of_a_clock_slower_than_the_samples(
    tmp_path: Path, clock: float, unit: float, phase: float
) -> None:
    t, u, y = signals(400)
    stamps = np.floor((t + phase * DT) / clock + 1e-9) * clock * unit
    path = write(tmp_path, ["t,u,y", *rows((stamps, u, y))])
    how = {"time": "t", "time_unit": {1.0: "s", 1e3: "ms", 1e6: "us"}[unit]}
    with pytest.raises(InputError, match=r"coarser than the samples.*mean rate is .*option repair"):
        read_record(path, "u", "y", **how)  # type: ignore[arg-type]
    record = read_record(path, "u", "y", repair=True, **how)  # type: ignore[arg-type]
    # The first and the last change of the stamp are each off by less than one of 400 samples.
    assert record.dt == pytest.approx(DT, rel=2 / 400)
    same_signals(record, u, y)
    assert "samples were taken as even" in record.notes[0]


def test_a_few_stamps_that_stand_twice_are_no_slow_clock(tmp_path: Path) -> None:
    t = T.copy()
    t[31] = t[30]
    path = write(tmp_path, ["t,u,y", *rows((t, U, Y))])
    with pytest.raises(InputError, match=r"time goes from 0\.15 s to 0\.15 s at line 33"):
        read_record(path, "u", "y", time="t", repair=True)


@pytest.mark.parametrize(
    ("stamps", "step", "note"),
    [
        (lambda t: np.floor(t * 1e3) / 1e3, 2.5e-3, "rounded to 0.001 s"),
        (lambda t: (t + 1e4).astype(np.float32).astype(float), 2.5e-3, "rounded to 0.000977 s"),
        (
            lambda t: t + np.random.default_rng(3).uniform(-1e-4, 1e-4, t.size),
            2.5e-3,
            "away from even steps;",
        ),
        # A counter of 200 us and a step that is no multiple of it.
        (lambda t: np.floor(t * 1.03 / 2e-4) * 2e-4, 2.575e-3, "away from even steps;"),
    ],
    ids=["decimals", "single precision", "jitter", "counts"],
)
def test_rounded_and_jittering_stamps_are_taken_as_even_and_told(
    tmp_path: Path, stamps: Callable[[np.ndarray], np.ndarray], step: float, note: str
) -> None:
    t, u, y = signals(400)
    body = rows((stamps(t / 2.0), u, y), write=lambda v: f"{v:.9f}")
    record = read_record(write(tmp_path, ["t,u,y", *body]), "u", "y", time="t")
    # A mean over 400 stamps, each off by less than half a step.
    assert record.dt == pytest.approx(step, rel=1 / 400)
    assert record.samples == 400
    assert note in record.notes[0]


@pytest.mark.parametrize("digits", [2, 3, 6])
@pytest.mark.parametrize("lost", [1, 3])
def test_lost_samples_are_no_rounding(tmp_path: Path, digits: int, lost: int) -> None:
    t, u, y = signals(400)
    t = 5.0 * t  # 0.025 s, which two decimals round
    keep = np.r_[0:200, 200 + lost : 400]
    body = rows((np.round(t, digits)[keep], u[keep], y[keep]), write=lambda v: f"{v:.6f}")
    path = write(tmp_path, ["t,u,y", *body])
    with pytest.raises(InputError, match=r"time is uneven, the worst gap is .* after line 201"):
        read_record(path, "u", "y", time="t")


@pytest.mark.parametrize(
    ("modulus", "unit", "scale"),
    [
        *((2**32, "us", 1e6), (2**16, "ms", 1e3), (2**24, "us", 1e6), (86400, "s", 1.0)),
        *((2**32 * 1e-6, "s", 1.0), (60, "s", 1.0), (3600e6 / 1e6, "s", 1.0)),
    ],
)
def test_counters_that_start_again_are_counted_on(
    tmp_path: Path, modulus: float, unit: str, scale: float
) -> None:
    stamps = np.mod(modulus - 20 * DT * scale + T * scale, modulus)
    path = write(tmp_path, ["t,u,y", *rows((stamps, U, Y), write=lambda v: f"{v:.6f}")])
    record = read_record(path, "u", "y", time="t", time_unit=unit)
    assert record.dt == pytest.approx(DT, rel=1e-6)  # six decimals of some thousand seconds
    same_signals(record, U, Y)
    assert "as a counter that is full" in record.notes[0]


def test_a_second_run_is_no_full_counter(tmp_path: Path) -> None:
    t = np.r_[np.arange(60), np.arange(60)] * 1.0  # 60 s again and again
    u, y = np.r_[U, U], np.r_[Y, Y]
    path = write(tmp_path, ["t,u,y", *rows((t, u, y))])
    with pytest.raises(InputError, match=r"holds 2 tables .*; 2: 60 rows from line 62 on"):
        read_record(path, "u", "y", time="t", repair=True)
    assert [each.samples for each in read_records(path, "u", "y", time="t")] == [60, 60]
    same_signals(read_record(path, "u", "y", time="t", table=2), U, Y)


@pytest.mark.parametrize("between", [[], ["", "# again", ""]])
def test_runs_without_a_header_between_them(tmp_path: Path, between: list[str]) -> None:
    body = rows((T, U, Y))
    late = rows((T + DT, U, Y))
    path = write(tmp_path, ["t,u,y", *body, *between, *late[:40], *between, *body])
    runs = read_records(path, "u", "y", time="t")
    assert [each.samples for each in runs] == [60, 40, 60]
    same_signals(runs[2], U, Y)
    # A fall to another instant is no new run.
    path = write(tmp_path, ["t,u,y", *body, *body[20:]])
    with pytest.raises(InputError, match=r"time goes from 0\.295 s to 0\.1 s at line 62"):
        read_record(path, "u", "y", time="t")


def test_stamps_that_fall_are_never_sorted(tmp_path: Path) -> None:
    t = T.copy()
    t[[30, 31]] = t[[31, 30]]
    path = write(tmp_path, ["t,u,y", *rows((t, U, Y))])
    with pytest.raises(InputError, match=r"at line 33; it must increase, so correct the stamps"):
        read_record(path, "u", "y", time="t", repair=True)


def test_columns_of_stamps_are_seconds_since_the_first(tmp_path: Path) -> None:
    path = write(tmp_path, ["stamp,u", "12:00:01,1", "12:00:03.5,2"])
    assert read_column(path, "stamp")[0].tolist() == [0.0, 2.5]
    assert read_column(path, "stamp")[2] == "s"

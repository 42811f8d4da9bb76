from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from hyst.errors import InputError
from hyst.signals import Record


def test_the_signals_are_read_only_copies_in_double() -> None:
    u = np.array([1, 2, 3])
    record = Record(u, [0.5, 1.0, 1.5], dt=0.1)
    u[0] = 99
    assert record.u.dtype == np.float64
    assert record.u.tolist() == [1.0, 2.0, 3.0]
    assert record.u.flags.c_contiguous
    for signal in (record.u, record.y):
        with pytest.raises(ValueError, match="read-only"):
            signal[0] = 0.0


def test_a_strided_view_becomes_contiguous() -> None:
    table = np.arange(12.0).reshape(6, 2)
    record = Record(table[:, 0], table[::-1, 1], dt=1.0)
    assert record.u.flags.c_contiguous
    assert record.y.flags.c_contiguous
    assert record.y.tolist() == [11.0, 9.0, 7.0, 5.0, 3.0, 1.0]


def test_the_fields_cannot_be_replaced() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        Record([1.0], [1.0], dt=1.0).dt = 2.0  # type: ignore[misc]


def test_time_runs_from_zero_to_the_duration() -> None:
    record = Record(np.zeros(5), np.zeros(5), dt=0.25)
    assert (record.samples, len(record), record.duration, record.rate) == (5, 5, 1.0, 4.0)
    assert record.time.tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]


def test_a_slice_keeps_names_units_and_notes() -> None:
    record = Record([1.0, 2, 3], [4.0, 5, 6], 0.1, "drive", "stroke", "V", "um", ("resampled",))
    part = record.slice(1, 3)
    assert part == Record([2.0, 3.0], [5.0, 6.0], 0.1, "drive", "stroke", "V", "um")
    assert part.notes == ("resampled",)


@pytest.mark.parametrize(("start", "stop"), [(0, 0), (2, 1), (-1, 2), (0, 4), (3, 4)])
def test_a_slice_outside_the_record_is_refused(start: int, stop: int) -> None:
    with pytest.raises(InputError, match=rf"samples {start} to {stop} out of a record of 3"):
        Record([1.0, 2, 3], [4.0, 5, 6], 0.1).slice(start, stop)


def test_equality_is_by_value() -> None:
    record = Record([1.0, 2.0], [3.0, 4.0], dt=0.1)
    assert record == Record(np.array([1, 2]), (3.0, 4.0), dt=0.1, notes=("from elsewhere",))
    assert record != Record([1.0, 2.5], [3.0, 4.0], dt=0.1)
    assert record != Record([1.0, 2.0], [3.0, 4.5], dt=0.1)
    assert record != Record([1.0, 2.0], [3.0, 4.0], dt=0.2)
    assert record != Record([1.0, 2.0], [3.0, 4.0], dt=0.1, output_unit="um")
    assert record != Record([1.0, 2.0, 3.0], [3.0, 4.0, 5.0], dt=0.1)
    assert record != "a record"


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_the_first_bad_index_and_its_signal_are_named(bad: float) -> None:
    with pytest.raises(InputError, match=r"input 'volts' is .*(nan|inf) at index 2"):
        Record([0.0, 1.0, bad, bad], [0.0, 1.0, 2.0, bad], 0.1, input_name="volts")
    with pytest.raises(InputError, match=r"output 'y' is .*(nan|inf) at index 3"):
        Record([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, bad], 0.1)


@pytest.mark.parametrize(
    ("u", "y", "message"),
    [
        ([], [], "input 'u' is empty"),
        ([1.0, 2.0], [1.0], "input 'u' and output 'y' have 2 and 1 samples"),
        ([[1.0], [2.0]], [1.0, 2.0], r"input 'u' has shape \(2, 1\)"),
        ([1.0, 2.0], ["a", "b"], "output 'y' has dtype <U1; give real numbers"),
        ([1.0, 2.0], [1j, 2j], "output 'y' has dtype complex128; give real numbers"),
        ([1.0, 2.0], [None, 1.0], "output 'y' has dtype object"),
        ([[1.0], [1.0, 2.0]], [1.0, 2.0], "input 'u' is not a rectangular array of numbers"),
    ],
)
def test_what_is_not_a_signal_is_refused(u: object, y: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Record(u, y, dt=1.0)  # type: ignore[arg-type]


@pytest.mark.parametrize("dt", [0.0, -0.1, np.nan, np.inf, None, "soon"])
def test_dt_must_be_positive_and_finite(dt: float) -> None:
    with pytest.raises(InputError, match=r"dt is .*; give the time between samples"):
        Record([1.0], [1.0], dt=dt)

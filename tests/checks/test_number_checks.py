"""What a number is, and the one sentence that refuses what is none."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hyst.checks.numbers import (
    as_not_negative,
    as_number,
    as_positive,
    as_reading,
    as_sample_time,
    said,
    whole_number,
)
from hyst.errors import InputError

NO_NUMBER = {
    "nan": float("nan"),
    "'0.5'": "0.5",
    "None": None,
    "True": True,
    "1j": 1j,
    "[1.0]": [1.0],
    "array([1.])": np.ones(1),
    "masked": np.ma.masked,
}
FINITE: dict[str, Callable[[Any], float]] = {
    "give a finite number": lambda value: as_number(value, "x"),
    "give seconds, above 0": lambda value: as_positive(value, "x", "seconds"),
    "give a share, above 0 and at most 1": lambda value: as_positive(value, "x", "a share", most=1),
    "give a finite number, 0 or more": lambda value: as_not_negative(value, "x"),
    "give the time between samples in seconds, above 0": lambda value: as_sample_time(value, "x"),
}


def refusal(check: Callable[[Any], float], value: Any) -> str:
    with pytest.raises(InputError) as caught:
        check(value)
    return str(caught.value)


@pytest.mark.parametrize("wanted", FINITE)
def test_what_is_no_number_is_refused_in_one_sentence(wanted: str) -> None:
    for shown, value in NO_NUMBER.items():
        assert refusal(FINITE[wanted], value) == f"x is {shown}; {wanted}"
    for value in (float("inf"), -float("inf"), np.float64(np.inf)):
        assert refusal(FINITE[wanted], value) == f"x is {float(value)}; {wanted}"


@pytest.mark.parametrize("wanted", FINITE)
def test_numbers_of_every_real_type_are_taken(wanted: str) -> None:
    for value in (0.5, np.float32(0.5), np.array(0.5)):
        taken = FINITE[wanted](value)
        assert type(taken) is float
        assert taken == 0.5
    for one in (1, np.int8(1), np.uint64(1), np.array(1)):
        assert FINITE[wanted](one) == 1.0


def test_ends_of_the_ranges() -> None:
    assert as_not_negative(0, "x") == 0.0
    assert as_positive(5e-324, "x") == 5e-324
    assert as_positive(1.0, "x", most=1.0) == 1.0
    assert as_positive(float("inf"), "x", infinite=True) == float("inf")
    for value in (0.0, -0.0, -1):
        assert refusal(lambda each: as_positive(each, "x"), value).endswith("above 0")
    assert "at most 1" in refusal(lambda each: as_positive(each, "x", most=1.0), 1.0 + 2e-16)
    assert "0 or more" in refusal(lambda each: as_not_negative(each, "x"), -5e-324)
    for value in (0.0, float("nan"), -float("inf")):
        refusal(lambda each: as_positive(each, "x", infinite=True), value)


def test_whole_numbers() -> None:
    for value in (3, np.int64(3), np.uint8(3)):
        taken = whole_number(value, "n", 3, 3)
        assert type(taken) is int
        assert taken == 3
    for shown, value in {
        "2": 2,
        "4": np.int16(4),
        "3.0": 3.0,
        "True": True,
        "True ": np.True_,
        "'3'": "3",
        "None": None,
    }.items():
        told = refusal(lambda each: whole_number(each, "n", 3, 3, ", or 'auto'"), value)
        assert told == f"n is {shown.strip()}; give a whole number from 3 to 3, or 'auto'"
    told = refusal(lambda each: whole_number(each, "n", 1, more=" samples"), 0)
    assert told == "n is 0; give a whole number, at least 1 samples"


def test_readings_may_be_anything_a_sensor_gives() -> None:
    assert as_reading(np.float32(0.5), "y") == 0.5
    assert np.isnan(as_reading(float("nan"), "y"))
    assert refusal(lambda each: as_reading(each, "y"), []) == "y is []; give a number"


def test_values_are_said_on_one_line_and_shortly() -> None:
    for value in (np.ones((30, 30)), "a\nb", "x" * 1000, 10**400, list(range(100))):
        text = said(value)
        assert "\n" not in text
        assert len(text) <= 40
    assert said(10**6000) == "a very large int"  # Python writes no number of so many digits

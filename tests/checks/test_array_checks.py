"""What a signal, a record and a list of constants are, and how what is none is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hyst.checks.arrays import (
    as_constants,
    as_signal,
    finite_array,
    finite_vector,
    one_each,
    one_record,
)
from hyst.errors import InputError

NAN = float("nan")
CHECKS: dict[str, Callable[[Any], Any]] = {
    "signal": lambda values: as_signal(values, "x"),
    "record": lambda values: one_record(values, "x"),
    "vector": lambda values: finite_vector(values, "x"),
    "array": lambda values: finite_array(values, "x"),
    "constants": lambda values: as_constants(values, "x"),
    "one each": lambda values: one_each(values, 2, "x", "play"),
}


def refusal(check: Callable[[Any], Any], values: Any) -> str:
    with pytest.raises(InputError) as caught:
        check(values)
    return str(caught.value)


@pytest.mark.parametrize("name", CHECKS)
def test_what_holds_no_real_numbers(name: str) -> None:
    check = CHECKS[name]
    assert refusal(check, ["a", "b"]) == "x has dtype <U1; give real numbers"
    assert refusal(check, [1j, 1.0]) == "x has dtype complex128; give real numbers"
    assert refusal(check, [None, 1.0]) == "x has dtype object; give real numbers"
    assert refusal(check, [[1.0], [1.0, 2.0]]).startswith("x is not a rectangular array")
    assert refusal(check, np.ma.masked_array([1.0, 2.0], [0, 1])).startswith(
        "x has masked entries, the first at index 1;"
    )


def test_the_first_number_that_is_not_finite_is_named() -> None:
    given = [1.0, NAN, np.inf]
    for name in ("signal", "record", "array", "constants"):
        assert refusal(CHECKS[name], given) == "x[1] is nan; every number must be finite"
    assert refusal(CHECKS["vector"], given) == (
        "x is nan at index 1; remove or repair samples that are not finite"
    )
    assert refusal(CHECKS["signal"], [[1.0, 2.0], [3.0, NAN]]).startswith("x[(1, 1)] is nan")
    assert refusal(CHECKS["one each"], NAN) == "x is nan; every number must be finite"


def test_shapes() -> None:
    table = np.ones((2, 3))
    assert as_signal(table, "x").shape == (2, 3)
    for name in ("record", "vector"):
        assert "give one record, a one-dimensional array" in refusal(CHECKS[name], table)
    for name in ("signal", "record", "vector"):
        assert refusal(CHECKS[name], []) == "x is empty; give at least one sample"
    assert as_constants([], "x").shape == (0,)
    assert refusal(CHECKS["constants"], 1.0) == "x has shape (); give a list of numbers"
    assert one_each(2, 2, "x", "play").tolist() == [2.0, 2.0]
    assert one_each([1, 2], 2, "x", "play").tolist() == [1.0, 2.0]
    assert refusal(CHECKS["one each"], [1.0]) == (
        "x has shape (1,); give one number, or one for each play"
    )


def test_what_is_kept_is_a_copy_nobody_can_write_to() -> None:
    given = np.ones(3)
    for name in ("vector", "constants"):
        kept = CHECKS[name](given)
        assert not kept.flags.writeable
        assert not np.shares_memory(kept, given)
    assert np.shares_memory(as_signal(given, "x"), given)  # a long record is not copied
    assert np.shares_memory(one_record(given, "x"), given)
    assert not np.shares_memory(finite_array(given, "x"), given)

"""Options of rate-dependent plays that are neither a word nor a count."""

from __future__ import annotations

from typing import Any

from hyst.checks.numbers import as_positive
from hyst.errors import InputError
from hyst.identification.families.option import (
    AUTO,
    Option,
    as_numbers,
    read_number,
    read_numbers,
)

EQUAL, HYSTERESIS = "equal", "hysteresis"
NO_FILTER = "none"


def _as_record_weights(given: Any, name: str) -> str | tuple[float, ...]:
    if isinstance(given, str):
        if given in (EQUAL, HYSTERESIS):
            return given
        raise InputError(
            f"{name} is {given!r}; choose {EQUAL!r}, {HYSTERESIS!r} or a number a record"
        )
    what = f"positive numbers, one a record, or {EQUAL!r} or {HYSTERESIS!r}"
    return tuple(as_numbers(given, name, what, 0.0).tolist())


def _read_record_weights(text: str, name: str) -> Any:
    return read_numbers(text, name) if "," in text else text


def _as_filter(given: Any, name: str) -> str | float:
    if isinstance(given, str):
        if given in (AUTO, NO_FILTER):
            return given
        raise InputError(f"{name} is {given!r}; give seconds, {AUTO!r} or {NO_FILTER!r}")
    return as_positive(given, name, f"seconds, {AUTO!r} or {NO_FILTER!r}")


def _read_filter(text: str, name: str) -> Any:
    return text if text in (AUTO, NO_FILTER) else read_number(text, name)


RECORD_WEIGHTS_OPTION = Option(
    _as_record_weights,
    "equal, hysteresis, or a number a record, as 1,1.56,2.",
    _read_record_weights,
    "WEIGHTS",
)
FILTER_OPTION = Option(
    _as_filter,
    "Noise of the measured drive: smoothed out where there is some, or with a time constant in "
    "seconds, or left.",
    _read_filter,
    "auto|none|SECONDS",
)

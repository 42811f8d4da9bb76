"""The options of hysteresis with dynamics: what each may be, and how it is read."""

from __future__ import annotations

from typing import Any

from hyst.checks.numbers import whole_number as as_whole_number
from hyst.errors import InputError
from hyst.identification.families.family import Family
from hyst.identification.families.hammerstein.known.given_dynamics import as_given_dynamics
from hyst.identification.families.hammerstein.known.held_front import as_held_front
from hyst.identification.families.option import (
    Option,
    as_text,
    read_whole,
    whole_number_or_auto,
)

MOST_LAGS, MOST_STATES, LONGEST_PERIOD = 5000, 64, 10**9


def _as_hysteresis(value: Any, name: str) -> Any:
    if isinstance(value, str | Family):
        return value
    raise InputError(
        f"{name} is of type {type(value).__name__}; give the name of a family, or a family of "
        "hyst.families with its options"
    )


def _as_period(value: Any, name: str) -> int | None:
    if value is None:
        return None
    return as_whole_number(value, name, 2, LONGEST_PERIOD, " samples")


HYSTERESIS = Option(
    _as_hysteresis, "Family in front of the dynamics.", lambda text, _: text, "FAMILY"
)
FIR_ORDER = whole_number_or_auto(
    1, MOST_LAGS, "Last lag of the impulse response the fit starts from; auto starts from plays."
)
STATE_ORDER = whole_number_or_auto(1, MOST_STATES, "Order of the linear dynamics.")
PERIOD = Option(
    _as_period,
    "Samples of a period of the drive; all but the first are averaged.",
    read_whole,
    "N",
)
DYNAMICS = Option(as_given_dynamics, "Linear dynamics that are known, held.", as_text, "FILE")
FRONT = Option(as_held_front, "Hysteresis that is known, held.", as_text, "FILE")

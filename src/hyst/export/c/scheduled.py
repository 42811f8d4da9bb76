"""The C of a model whose constants follow a second signal: a table of them, and the step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.errors import InputError
from hyst.export.c.core_stage import CoreStage
from hyst.export.c.numbers import Precision, table
from hyst.export.c.stage_code import StageCode, values_of
from hyst.models.schedule_run import ScheduledSystem

OFF_SCHEDULE = (
    "#define @{NAME}_OFF_SCHEDULE 8u /* the second signal was outside the schedule: constants are "
    "held at its end */\n"
)


Knots = tuple[tuple[CoreStage, ...], ...]


@final
@dataclass(frozen=True)
class ScheduledCode:
    """The C of stages whose constants follow a second signal.

    Parameters
    ----------
    code
        The stages at the first value of the schedule, with those behind them that only a start
        needs; their constants stand in the array ``now``.
    knots
        The stages of the step at each value of the schedule.
    head
        C declarations of constants for the head of the file.
    moving
        Numbers of ``now`` that a step takes, and that a start takes.
    """

    code: StageCode
    knots: Knots
    head: str
    moving: tuple[int, int]

    @classmethod
    def of(
        cls, model: ScheduledSystem, knots: Knots, precision: Precision, start: Knots = ()
    ) -> ScheduledCode:
        """Write the C of ``knots``.

        Parameters
        ----------
        model
            A scheduled model or its inverse.
        knots
            What its step passes at each value of the schedule.
        precision
            Of the target.
        start
            What a start passes beside that; nothing if left out.

        Raises
        ------
        InputError
            If a constant cannot be written in that precision, values of the schedule are one
            number in it, or stages inside a stage meet single precision.
        """
        whole = tuple((*a, *b) for a, b in zip(knots, start or ((),) * len(knots), strict=True))
        _require_precision(model, whole, precision)
        moving, ends = dict[int, int](), [0]
        for part in (range(len(knots[0])), range(len(knots[0]), len(whole[0]))):
            first = ends[-1]
            for index in part:
                values = [values_of(each[index]) for each in whole]
                if any(each != values[0] for each in values):
                    moving[index] = first
                    first += len(values[0])
            ends.append(first)
        code = StageCode(whole[0], precision, now=moving)
        head = code.declarations() + _values(model, precision)
        for name, first, last in (
            ("schedule", 0, ends[1]),
            ("actuator_schedule", ends[1], ends[2]),
        ):
            rows = [
                value
                for each in whole
                for index, place in moving.items()
                if first <= place < last
                for value in values_of(each[index])
            ]
            if name == "schedule" or rows:
                head += _schedule(name, len(knots), last - first, rows or [0.0], precision)
        return cls(code, knots, head, (ends[1], ends[2]))

    @property
    def headers(self) -> tuple[str, ...]:
        """Of the core, that the stages need."""
        return (*self.code.headers(), "hyst/schedule.h")

    @property
    def taken(self) -> str:
        """C of a step that takes the constants at ``s``; where that is not finite, ``u`` is so."""
        return (
            f"hyst_real now[{max(self.moving[0], 1)}]; /* constants at s */\n"
            f"{_AT_S}if (!hyst_is_finite(s)) {{\n    u = s;\n}}\n"
        )

    @property
    def prepared(self) -> tuple[str, str]:
        """C of a start: the array of constants, and what takes them; 1 for what is not finite."""
        own, all_of_them = self.moving
        beside = (
            f"(void)hyst_schedule_constants(&actuator_schedule, s, now + {own});\n"
            if all_of_them > own
            else ""
        )
        return (
            f"hyst_real now[{max(all_of_them, 1)}]; /* constants at s */\n",
            f"if (!hyst_is_finite(s)) {{\n    return 1;\n}}\n{_AT_S}{beside}",
        )


_AT_S = """\
if (hyst_schedule_constants(&schedule, s, now) != 0) {
    state->fault |= @{NAME}_OFF_SCHEDULE;
}
"""


def _values(model: ScheduledSystem, precision: Precision) -> str:
    values = model.values.tolist()
    at = table(values, precision, "values")
    return f"static const hyst_real schedule_at[{len(values)}] = {at};\n"


def _schedule(name: str, knots: int, count: int, rows: list[float], precision: Precision) -> str:
    values = table(rows, precision, "constants")
    return (
        f"static const hyst_real {name}_row[{len(rows)}] = {values};\n"
        f"static const hyst_schedule {name} = {{{knots}u, {count}u, schedule_at, {name}_row}};\n"
    )


def _require_precision(model: ScheduledSystem, knots: Knots, precision: Precision) -> None:
    if precision == "double":
        return
    if any(stage.inside for stage in knots[0]):
        raise InputError(
            "a scheduled model with stages inside a stage is exported in double precision only"
        )
    rounded = model.values.astype(np.float32)
    if (np.diff(rounded) <= 0.0).any():
        raise InputError(
            f"values of {model.name} are one number in single precision; choose double, or values "
            "further apart"
        )


def second_values(model: ScheduledSystem) -> tuple[float, ...]:
    """Give values of the second signal for a self-test: at, between and beyond those it knows.

    Parameters
    ----------
    model
        A scheduled model or its inverse.

    Returns
    -------
    tuple of float
        16 numbers of single precision.
    """
    low, high = float(model.values[0]), float(model.values[-1])
    span = np.linspace(low - 0.25 * (high - low), high + 0.25 * (high - low), 16)
    return tuple(np.concatenate([span[5:], span[:5]]).astype(np.float32).astype(float).tolist())

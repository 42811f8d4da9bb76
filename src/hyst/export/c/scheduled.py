"""The C of a model whose constants follow a second signal: a table of them, and the step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.errors import InputError
from hyst.export.c.core_stage import CoreStage, stages_as_core
from hyst.export.c.numbers import Precision, table
from hyst.export.c.stage_code import StageCode, values_of
from hyst.models.schedule_run import ScheduledSystem

OFF_SCHEDULE = (
    "#define @{NAME}_OFF_SCHEDULE 8u /* the second signal was outside the schedule: constants are "
    "held at its end */\n"
)


@final
@dataclass(frozen=True)
class ScheduledCode:
    """What the block of a scheduled model is made of.

    Parameters
    ----------
    head, body, headers
        As of a ``Block``; the body takes ``u`` and ``s`` and leaves the output in ``u``.
    knots
        The stages at each value of the schedule.
    """

    head: str
    body: str
    headers: tuple[str, ...]
    knots: tuple[tuple[CoreStage, ...], ...]


def scheduled_code(model: ScheduledSystem, precision: Precision) -> ScheduledCode:
    """Give the C of a model whose constants follow a second signal.

    Parameters
    ----------
    model
        A scheduled model or its inverse.
    precision
        Of the target.

    Returns
    -------
    ScheduledCode

    Raises
    ------
    InputError
        If its constants cannot move, a constant cannot be written in that precision, values of the
        schedule are one number in it, or stages inside a stage meet single precision.
    """
    knots = tuple(stages_as_core(stages) for stages in model.knot_stages)
    _require_precision(model, knots, precision)
    moving, first = dict[int, int](), 0
    for index, stage in enumerate(knots[0]):
        if any(values_of(each[index]) != values_of(stage) for each in knots):
            moving[index] = first
            first += len(values_of(stage))
    codes = [StageCode(each, precision, now=moving) for each in knots]
    rows = [value for each in knots for index in moving for value in values_of(each[index])]
    head = codes[0].declarations() + _schedule(model, rows or [0.0], first, precision)
    body = (
        f"hyst_real now[{max(first, 1)}]; /* constants at s */\n"
        "if (hyst_schedule_constants(&schedule, s, now) != 0) {\n"
        "    state->fault |= @{NAME}_OFF_SCHEDULE;\n"
        "}\n"
        "if (!hyst_is_finite(s)) {\n"
        "    u = s;\n"
        "}\n"
    )
    headers = (*codes[0].headers(), "hyst/schedule.h")
    return ScheduledCode(head, body + codes[0].calls(), headers, knots)


def _schedule(model: ScheduledSystem, rows: list[float], count: int, precision: Precision) -> str:
    values = model.values.tolist()
    at, table_of_rows = table(values, precision, "values"), table(rows, precision, "constants")
    return (
        f"static const hyst_real schedule_at[{len(values)}] = {at};\n"
        f"static const hyst_real schedule_row[{len(rows)}] = {table_of_rows};\n"
        f"static const hyst_schedule schedule = {{{len(values)}u, {count}u, schedule_at, "
        "schedule_row};\n"
    )


def _require_precision(
    model: ScheduledSystem, knots: tuple[tuple[CoreStage, ...], ...], precision: Precision
) -> None:
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

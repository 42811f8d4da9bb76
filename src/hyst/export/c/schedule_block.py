"""Blocks whose constants follow a second signal: a model or an inverse, with limits or without."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from hyst import _engine, _single
from hyst.control.drive_limits import stated, within
from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.export.c.core_stage import stages_as_core
from hyst.export.c.drive_block import model_body, tested
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.exported import Block, Memory
from hyst.export.c.following import Following, Passed, overflows, told
from hyst.export.c.limited import OUT_OF_RANGE, LimitedStages, limits_in, limits_stage
from hyst.export.c.numbers import Precision
from hyst.export.c.scheduled import OFF_SCHEDULE, Knots, ScheduledCode, second_values
from hyst.models.scheduled import Scheduled
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.operators.stage import Stage

System = Scheduled | ScheduledInverse


def scheduled_block(model: System, precision: Precision) -> Block:
    """Give what is exported of a scheduled model or its inverse whose drive is not limited.

    Parameters
    ----------
    model
        From the drive on; or an inverse, whose output is the drive.
    precision
        Of the target.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If its constants cannot move, or cannot be written in that precision.
    """
    own, start = _knots(model.knot_stages), _beside(model)
    made = ScheduledCode.of(model, own, precision, start)
    count = len(own[0])
    passed = [Passed(model.knot_stages[0], 0, 0)]
    if start:
        before = tuple(_model(model).initial_state().tolist())
        passed.insert(0, Passed(_model(model).knot_stages[0], count, None, before))

    def single_stepper(memory: Memory) -> Callable[..., float]:
        return _single.MovingStepper(model.values.tolist(), _told(own), memory)

    return Block(
        kind=model.kind,
        inputs=("u", "s"),
        output="y",
        head=made.head,
        body=made.taken + made.code.calls(only=range(count)),
        signal="u",
        headers=made.headers,
        start=tuple(model.initial_state().tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=own[0],
        chain=_first(model),
        stepper=model.stepper,
        single_stepper=single_stepper,
        second=second_values(model),
        second_meaning=(model.name, model.unit),
        schedule=(float(model.values[0]), float(model.values[-1])),
        faults=OFF_SCHEDULE,
        drive=DriveRange("output" if start else "input"),
        following=_following(model, made, passed, None),
    )


def limited_schedule_block(
    model: LimitedSchedule, precision: Precision, source: str = "as given"
) -> Block:
    """Give what is exported of one whose drive is limited.

    Parameters
    ----------
    model
        A scheduled model or its inverse with its limits.
    precision
        Of the target.
    source
        Where the limits come from.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If a constant cannot be written in that precision, or no number is left between the limits.
    """
    system, is_output = model.system, model.drive == "output"
    limits = limits_in(precision, *model.numbers)
    own, forward = _knots(system.knot_stages), _beside(system)
    if is_output:
        pairs = zip(own, forward, strict=True)
        parts = [LimitedStages(None, a, b, limits, ()) for a, b in pairs]
        made = ScheduledCode.of(system, tuple(each.all for each in parts), precision)
        body, place = parts[0].body(made.code), system.initial_state().size
        beside = Passed(_model(system).knot_stages[0], len(own[0]), place)
        passed = [beside, Passed(system.knot_stages[0], 0, 0)]
    else:
        end = limits_stage(limits, {"forward": 0, "way": 0})
        made = ScheduledCode.of(system, tuple((*each, end) for each in own), precision)
        body, passed = model_body(made.code), [Passed(system.knot_stages[0], 0, 0)]
    start = model.initial_state()
    start[-1] = within(limits[:2], float(start[-1]))
    return Block(
        kind=system.kind,
        inputs=("u", "s"),
        output="y",
        head=made.head,
        body=made.taken + body,
        signal="v" if is_output else "u",
        headers=made.headers,
        start=tuple(start.tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=made.knots[0],
        chain=_first(system),
        stepper=model.stepper,
        single_stepper=lambda memory: _limited(system, limits, "single", memory),
        second=second_values(system),
        second_meaning=(system.name, system.unit),
        schedule=(float(system.values[0]), float(system.values[-1])),
        faults=OFF_SCHEDULE + OUT_OF_RANGE,
        tells=("OUT_OF_RANGE",),
        drive=DriveRange.of(model.drive, model.limits, model.rate, precision, source),
        rest=float(start[-1]) if is_output else 0.0,
        following=_following(system, made, passed, start.size - 1),
        tested=tested(model.limits, _model(system).models if is_output else ()),
    )


def _following(
    model: System, made: ScheduledCode, passed: Sequence[Passed], last: int | None
) -> Following:
    """Give the start of a block: its memory is led through drives at one second signal."""
    is_inverse = isinstance(model, ScheduledInverse)

    def moved(
        memory: Memory, drives: Sequence[float], second: float, precision: Precision
    ) -> tuple[Memory, float]:
        steps = _limited(model, stated(None, None, 1.0), precision, _whole(model, memory))
        answer = 0.0
        for k, each in enumerate(drives):
            if is_inverse:
                answer, is_bad = each, not steps.lead(each, second)
            else:
                answer, is_bad = steps(each, second), steps.fault
            if is_bad:
                raise overflows(drives, k)
        state = (*np.array(steps.state).tolist()[:-1], drives[-1])
        return state[: len(memory)], answer

    return Following.of(
        made.code,
        passed,
        last,
        "drive" if is_inverse else "signal",
        prepared=made.prepared,
        moved=moved,
    )


def _whole(model: System, memory: Memory) -> Memory:
    """Give the memory of a limited drive that begins as a ``memory`` without one does."""
    start = model.initial_state()
    if isinstance(model, ScheduledInverse):
        start = np.concatenate([start, _model(model).initial_state()])
    whole = (*start.tolist(), 0.0)
    return (*memory, *whole[len(memory) :])


def _limited(
    model: System, limits: tuple[float, float, float], precision: Precision, memory: Memory
) -> Any:
    """Give what steps and leads in a ``precision``."""
    at, is_inverse = model.values.tolist(), isinstance(model, ScheduledInverse)
    own = model.knot_stages
    beside = _model(model).knot_stages if is_inverse else ((),) * len(at)
    if precision == "double":
        start = np.array(memory, dtype=np.float64)
        return _engine.LimitedMovingStepper(at, own, beside, is_inverse, *limits, start)
    largest = float(np.finfo(np.float32).max)
    low, high = max(limits[0], -largest), min(limits[1], largest)
    return _single.LimitedMovingStepper(
        at, _told(_knots(own)), _told(_knots(beside)), is_inverse, low, high, limits[2], memory
    )


def _model(model: System) -> Scheduled:
    return model if isinstance(model, Scheduled) else model.scheduled


def _first(model: System) -> Any:
    first = _model(model).models[0]
    return first if isinstance(model, Scheduled) else first.inverse()


def _beside(model: System) -> Knots:
    """Give the model in front of an inverse; nothing for a model."""
    return () if isinstance(model, Scheduled) else _knots(model.scheduled.knot_stages)


def _knots(stages: Sequence[Sequence[Stage]]) -> Knots:
    return tuple(stages_as_core(each) for each in stages)


def _told(knots: Knots) -> list[list[Any]]:
    return [[told(stage) for stage in each] for each in knots]

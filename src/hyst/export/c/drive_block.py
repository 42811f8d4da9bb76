"""The block of a limited drive: of an inverse or of a model, clipped as the core does it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from hyst.control.drive_limits import Limits, within
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.export.c.core_stage import CoreStage, core_stages
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.exported import Block
from hyst.export.c.following import Following, Passed
from hyst.export.c.limited import (
    OUT_OF_RANGE,
    LimitedStages,
    bank_limits_stage,
    limits_in,
    limits_stage,
)
from hyst.export.c.numbers import Precision
from hyst.export.c.stage_code import StageCode
from hyst.export.c.start import SOLVED_HEADER, bank_passed
from hyst.export.c.templating import indented
from hyst.operators import Operator

# Beyond what the limits leave in reach, of its range: so far a self-test goes.
_BEYOND = 0.25
_RUN = 64

_RAISED = "state->fault |= @{NAME}_OUT_OF_RANGE;"


def limited_block(model: LimitedDrive, precision: Precision, source: str = "as given") -> Block:
    """Give what is exported of a limited drive.

    Parameters
    ----------
    model
        An inverse or a model with its limits.
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
    limits = limits_in(precision, *model.numbers)
    stages, body = _parts(model, limits, precision)
    code = StageCode(stages, precision)
    start = model.initial_state()
    start[-1] = within(limits[:2], float(start[-1]))
    is_output = model.drive == "output"
    return Block(
        kind=model.operator.kind,
        inputs=("u",),
        output="y",
        head=code.declarations(),
        body=body(code),
        signal="v" if is_output else "u",
        headers=tuple(sorted({*code.headers(), *_start_headers(model)})),
        start=tuple(start.tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        chain=model.operator,
        stepper=model.stepper,
        faults=OUT_OF_RANGE,
        written=body,
        tells=("OUT_OF_RANGE",),
        drive=DriveRange.of(model.drive, model.limits, model.rate, precision, source),
        rest=float(start[-1]) if is_output else 0.0,
        following=_following(model, code),
        tested=tested(model.limits, () if model.forward is None else (model.forward,)),
    )


Body = Callable[[StageCode], str]


def _parts(
    model: LimitedDrive, limits: tuple[float, float, float], precision: Precision
) -> tuple[tuple[CoreStage, ...], Body]:
    """Give the stages in the order of their memory, and what writes the step with them."""
    own = core_stages(model.operator)
    if model.drive == "input":
        told = limits_stage(limits, {"forward": 0, "way": 0})
        return (*own, told), model_body
    if model.bank is not None:
        dtype = np.float32 if precision == "single" else np.float64
        ends = model.bank_limits(limits[0], limits[1], dtype)
        return (*own, bank_limits_stage(ends)), _bank_body
    forward = () if model.forward is None else core_stages(model.forward)
    held = LimitedStages(None, own, forward, limits, ())
    return held.all, held.body


def model_body(code: StageCode) -> str:
    """Give C that clips what drives a model, with the last of the stages of its ``code``."""
    last = len(code.stages) - 1
    clipped = code.calls("u", only=range(last, last + 1)).rstrip("\n")
    return (
        "if (hyst_is_finite(u)) {\n    const hyst_real wanted = u;\n"
        f"{indented(clipped)}\n"
        f"    if ((u < wanted) || (u > wanted)) {{\n        {_RAISED}\n    }}\n}}\n"
        + code.calls("u", only=range(last))
    )


def _bank_body(code: StageCode) -> str:
    """Clip what a bank of plays at the end of an inverse gives, and move its plays with that."""
    bank, limits = len(code.stages) - 2, len(code.stages) - 1
    count = code.stages[bank].state_length
    call = (
        f"v = hyst_limited_bank_step(&{code.name(bank)}, &{code.name(limits)}, memory, &held, v);"
    )
    step = (
        "int held = 0;\n"
        + code.local(bank)
        + code.local(limits)
        + f"{call}\nif (held != 0) {{\n    {_RAISED}\n}}\n"
    )
    if bank == 0:
        return f"hyst_real v = u;\nif (hyst_is_finite(v)) {{\n{indented(step)}\n}}\n"
    return (
        "hyst_real v = u;\nif (hyst_is_finite(v)) {\n"
        + indented(code.calls("v", only=range(bank)))
        + "\n    if (!hyst_is_finite(v)) { /* no drive belongs to it: the last one is kept */\n"
        + "        state->fault |= @{NAME}_NOT_FINITE | @{NAME}_OUT_OF_RANGE;\n"
        + f"        v = memory[{count}];\n    }} else {{\n{indented(step, 8)}\n    }}\n}}\n"
    )


def _following(model: LimitedDrive, code: StageCode) -> Following:
    own = model.operator.stages()
    length = model.operator.initial_state().size
    if model.drive == "input":
        return Following.of(code, [Passed(own, 0, 0)], length, "signal")
    if model.bank is not None:
        return Following.of(code, [bank_passed(model.operator, 0, 0)], length)
    if model.forward is None:
        return Following.of(code, [], length)
    forward = Passed(model.forward.stages(), len(core_stages(model.operator)), length)
    last = length + model.forward.initial_state().size
    return Following.of(code, [forward, Passed(own, 0, 0)], last)


def _start_headers(model: LimitedDrive) -> tuple[str, ...]:
    return (SOLVED_HEADER,) if model.bank is not None else ()


def tested(limits: Limits | None, forward: Sequence[Operator]) -> tuple[float, float] | None:
    """Give the range of a self-test: what is in reach within the limits, and some more.

    Parameters
    ----------
    limits
        Of the drive; None without.
    forward
        Models in front of the inverse, of which the one that reaches farthest counts; none where
        the drive is the input.
    """
    if limits is None:
        return None
    low, high = limits
    if forward:
        ends = [_reached(each, *limits) for each in forward]
        low, high = min(each[0] for each in ends), max(each[1] for each in ends)
    more = _BEYOND * (high - low)
    return low - more, high + more


def _reached(forward: Operator, low: float, high: float) -> tuple[float, float]:
    ends = [within((low, high), 0.0), low, high, low, high]
    y = forward.run(np.interp(np.arange(4 * _RUN + 1) / _RUN, np.arange(5), ends))[0]
    return float(y.min()), float(y.max())

"""The blocks of controllers: reference and measured output in, drive out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.control.drive_limits import stated, within
from hyst.control.repetitive.controller import RepetitiveController
from hyst.control.repetitive.saved import REPETITIVE_KIND
from hyst.control.saved_block import KIND
from hyst.control.tracking_controller import TrackingController
from hyst.export.c.core_stage import CoreStage, core_stages
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.exported import Block
from hyst.export.c.following import Following, Passed
from hyst.export.c.limited import OUT_OF_RANGE, LimitedStages, limits_in
from hyst.export.c.numbers import Precision
from hyst.export.c.repetitive import REFERENCE_CHANGED, RepetitiveStages
from hyst.export.c.stage_code import StageCode
from hyst.export.c.start import with_start
from hyst.operators import Affine, Operator, Play
from hyst.operators.registry import compose

Array = NDArray[np.float64]


def tracking_block(model: TrackingController, precision: Precision) -> Block:
    """Give what is exported of a ``model``, a tracking controller, in a ``precision``."""
    inverse = () if model.inverse is None else core_stages(model.inverse)
    # What the test signal passes: the gain from y_ref to v, then the inverse.
    gain = Affine(abs(float(model.D[0])) or 1.0)
    passed = gain if model.inverse is None else compose((gain, model.inverse))
    if model.W is not None:
        return _limited(model, model.W, inverse, passed, precision)
    code = StageCode((_linear_part(model), *inverse), precision)
    block = Block(
        kind=KIND,
        inputs=("y_ref", "y"),
        output="u",
        head=code.declarations(),
        body="hyst_real v = (y_ref - y_ref) + (y - y); /* 0, or NaN if one is not finite */\n"
        + code.calls("v"),
        signal="v",
        headers=code.headers(),
        start=tuple(model.initial_state().tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        chain=passed,
        stepper=model.stepper,
        drive=_drive(model, precision),
    )
    return _started(block, code, model, model.order)


def _limited(
    model: TrackingController,
    W: Array,
    inverse: tuple[CoreStage, ...],
    passed: Operator,
    precision: Precision,
) -> Block:
    forward = () if model.forward is None else core_stages(model.forward)
    numbers = limits_in(precision, *stated(model.limits, model.rate, model.dt))
    stages = LimitedStages(_linear_part(model), inverse, forward, numbers, tuple(W.tolist()))
    code = StageCode(stages.all, precision)
    low, high, _ = numbers
    last = within((low, high), model.u0)
    reach = [abs(each) for each in model.limits or () if each != 0.0]
    block = Block(
        kind=KIND,
        inputs=("y_ref", "y"),
        output="u",
        head=code.declarations(),
        body=stages.body(code),
        signal="v",
        headers=code.headers(),
        start=(*model.initial_state()[:-1].tolist(), last),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        # Far enough to meet the limits, too.
        chain=compose((passed, Play(max(reach)))) if reach else passed,
        stepper=model.stepper,
        faults=OUT_OF_RANGE,
        written=stages.body,
        tells=("OUT_OF_RANGE",),
        drive=_drive(model, precision),
        rest=last,
    )
    return _started(block, code, model, model.order)


def repetitive_block(model: RepetitiveController, precision: Precision) -> Block:
    """Give what is exported of a ``model``, a repetitive controller, in a ``precision``."""
    stages = RepetitiveStages.of(model, precision)
    code = StageCode(stages.all, precision)
    passed = Affine(1.0) if model.inverse is None else model.inverse
    start = model.initial_state()
    tells = ("OUT_OF_RANGE",) if stages.limits is not None else ()
    if stages.limits is not None:
        start[-1] = within(stages.limits[:2], model.u0)
        reach = [abs(each) for each in model.limits or () if each != 0.0]
        # Far enough to meet the limits, too.
        passed = compose((passed, Play(max(reach)))) if reach else passed
    block = Block(
        kind=REPETITIVE_KIND,
        inputs=("y_ref", "y"),
        output="u",
        head=code.declarations(),
        body=stages.body(code),
        signal="v",
        headers=code.headers(),
        start=tuple(start.tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        chain=passed,
        stepper=model.stepper,
        faults=("" if stages.limits is None else OUT_OF_RANGE)
        + ("" if model.tolerance is None else REFERENCE_CHANGED),
        written=stages.body,
        drive=_drive(model, precision),
        rest=0.0 if stages.limits is None else float(start[-1]),
        forgets=model.compiled.memory_length,
        tells=tells if model.tolerance is None else (*tells, "REFERENCE_CHANGED"),
    )
    return _started(block, code, model, model.compiled.memory_length)


def _started(
    block: Block, code: StageCode, model: TrackingController | RepetitiveController, place: int
) -> Block:
    """Give the block with its start; the memory of the inverse is at a ``place``."""
    if model.inverse is None:
        last = len(block.start) - 1 if model.is_limited else None
        return replace(block, following=Following.of(code, (), last))
    if not model.is_limited or model.forward is None:
        return with_start(block, code, model.inverse, place, 1)
    count, length = len(core_stages(model.inverse)), model.inverse.initial_state().size
    passed = [
        Passed(model.forward.stages(), 1 + count, place + length),
        Passed(model.inverse.stages(), 1, place),
    ]
    return replace(block, following=Following.of(code, passed, len(block.start) - 1))


def _drive(model: TrackingController | RepetitiveController, precision: Precision) -> DriveRange:
    source = "of the controller" if model.is_limited else "none: the controller was given none"
    return DriveRange.of("output", model.limits, model.rate, precision, source)


def _linear_part(model: TrackingController) -> CoreStage:
    tables = {
        "a": tuple(model.A.T.ravel().tolist()),
        "b": tuple(model.B.T.ravel().tolist()),
        "c": tuple(model.C.tolist()),
    }
    numbers = {"d_y_ref": float(model.D[0]), "d_y": float(model.D[1])}
    return CoreStage(
        kind="tracking_controller",
        numbers=numbers,
        tables=tables,
        choices={},
        form="",
        state_length=model.order,
        offers=dict.fromkeys((*numbers, *tables), (0, "")),
        feeds_through=True,
        header="hyst/tracking_controller.h",
        # Without an inverse: its stages are called one by one, after the linear part.
        structure="hyst_tracking_controller $model = "
        "{#c, $a, $b, $c, {$d_y_ref, $d_y}, {0u, NULL}};",
        call="$signal = hyst_tracking_controller_linear(&$model, $memory, y_ref, y);",
    )

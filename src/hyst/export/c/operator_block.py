"""The block of an operator: one signal in, one out."""

from __future__ import annotations

from dataclasses import replace

from hyst.control.limited_drive.checked import SIDE_NOT_KNOWN
from hyst.export.c.core_stage import core_stages
from hyst.export.c.drive_range import DriveRange, Side
from hyst.export.c.exported import Block
from hyst.export.c.following import Following, Passed
from hyst.export.c.numbers import Precision
from hyst.export.c.stage_code import StageCode
from hyst.export.c.start import with_start
from hyst.operators import Operator


def operator_block(model: Operator, precision: Precision) -> Block:
    """Give what is exported of an operator whose drive is not limited.

    Parameters
    ----------
    model
        A model, from the drive on; or an inverse, whose output is the drive.
    precision
        Of the target.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If a constant cannot be written in that precision.
    """
    code = StageCode(core_stages(model), precision)
    side: Side = "output" if model.description.is_inverse else "input"
    if model.description.is_inverse is None:
        side = ""
    block = Block(
        kind=model.kind,
        inputs=("u",),
        output="y",
        head=code.declarations(),
        body=code.calls(),
        signal="u",
        headers=code.headers(),
        start=tuple(model.initial_state().tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        chain=model,
        stepper=model.stepper,
        drive=DriveRange(side),
    )
    if side == "":
        return replace(block, no_start=SIDE_NOT_KNOWN)
    if side == "output":
        return with_start(block, code, model, 0)
    passed = [Passed(model.stages(), 0, 0)]
    return replace(block, following=Following.of(code, passed, answers="signal"))

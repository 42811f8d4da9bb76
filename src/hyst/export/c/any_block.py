"""Whatever can be exported as C, with what is told of its drive."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from hyst.control.drive_limits import Limits, within
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.control.repetitive.controller import RepetitiveController
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError
from hyst.export.c.any_estimator import any_estimator_block
from hyst.export.c.block import Block, Model, block_of, described
from hyst.export.c.drive_block import limited_block
from hyst.export.c.drive_options import DriveOptions, ends_of, limited, limited_schedule
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.driver_codes import with_codes
from hyst.export.c.names import plain_text
from hyst.export.c.numbers import Precision
from hyst.export.c.schedule_block import limited_schedule_block
from hyst.export.c.start import after_history
from hyst.models.scheduled import Scheduled
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.online import JointEstimator, ScaleEstimator
from hyst.operators import ModelDescription, Operator


def any_block(
    model: Model,
    precision: Precision,
    options: DriveOptions,
    description: ModelDescription | None = None,
) -> Block:
    """Give what is exported.

    Parameters
    ----------
    model
        As an export is given it.
    precision
        Of the target.
    options
        What it is told of the drive.
    description
        As given; None for that of the model.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If it cannot be exported, or with these limits or that history not.
    NotInvertibleError
        If the model turns back within the limits.
    """
    about = described(model, description)
    if isinstance(model, Operator) and about.is_inverse and not model.description.is_inverse:
        model = model.with_description(about)  # which of its signals the drive is
    block = _block(model, precision, options, about)
    unit = about.output_unit if block.drive.side == "output" else about.input_unit
    block = replace(block, drive=replace(block.drive, unit=plain_text(unit)))
    block = after_history(block, options.history, precision, options.history_at)
    return with_codes(block, options.codes)


def _block(
    model: Model, precision: Precision, options: DriveOptions, about: ModelDescription
) -> Block:
    if isinstance(model, JointEstimator | ScaleEstimator):
        return _estimator(model, precision, options, about)
    if isinstance(model, Operator):
        had = limited(model, options, about)
        if isinstance(had.model, LimitedDrive):
            return limited_block(had.model, precision, had.source)
        block = block_of(had.model, precision)
        return replace(block, drive=replace(block.drive, source=had.source))
    if isinstance(model, Scheduled | ScheduledInverse):
        had = limited_schedule(model, options, about)
        if isinstance(had.model, LimitedSchedule):
            return limited_schedule_block(had.model, precision, had.source)
        block = block_of(model, precision)
        return replace(block, drive=replace(block.drive, source=had.source))
    if isinstance(model, LimitedDrive | LimitedSchedule):
        instead = "leave it out, or export its operator"
        options.refuse("a limited drive has its own limits", instead, True)
    elif isinstance(model, TrackingController | RepetitiveController):
        what = f"a {type(model).__name__} limits its drive itself"
        options.refuse(what, "make the controller with limits", model.is_limited)
    return block_of(model, precision)


def _estimator(
    model: JointEstimator | ScaleEstimator,
    precision: Precision,
    options: DriveOptions,
    about: ModelDescription,
) -> Block:
    """Give an estimator whose commands are clamped; its memory follows what it is told."""
    if options.rate is not None:
        raise InputError(
            "the command of an estimator is no sequence of samples, so rate_limit cannot be given; "
            "limit the rate beside it"
        )
    limits, source = ends_of(options, "input", about, model.description)
    drive = DriveRange.of("command", limits, None, precision, source)
    block = any_estimator_block(model, precision)
    block = replace(
        block, drive=drive, no_start="an estimator goes on from the memory that it has now"
    )
    if drive.limits is not None:
        block = replace(
            block,
            rest=within(drive.limits, 0.0),
            stepper=_clamped(block.stepper, drive.limits),
            single_stepper=_clamped(block.single_stepper, drive.limits),
        )
    return block


def _clamped(made: Any, limits: Limits) -> Any:
    """Make of what makes a stepper what makes one whose output is clamped."""

    def make(memory: Any) -> Callable[..., float]:
        step = made(memory)
        return lambda *sample: within(limits, step(*sample))

    return make

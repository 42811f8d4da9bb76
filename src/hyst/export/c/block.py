"""What is exported: signals, memory, and the C that takes one sample."""

from __future__ import annotations

from hyst.control.limited_drive.drive import LimitedDrive
from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.control.repetitive.controller import RepetitiveController
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError
from hyst.export.c.controllers import repetitive_block, tracking_block
from hyst.export.c.drive_block import limited_block
from hyst.export.c.exported import Block, stepper_of
from hyst.export.c.numbers import Precision
from hyst.export.c.operator_block import operator_block
from hyst.export.c.schedule_block import limited_schedule_block, scheduled_block
from hyst.models.schedule_run import ScheduledSystem
from hyst.models.scheduled import Scheduled
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.models.stable_inverse import StableInverse
from hyst.online import JointEstimator, ScaleEstimator
from hyst.operators import ModelDescription, Operator
from hyst.operators.verdict import refuse_if_unfit

__all__ = ["Block", "Model", "block_of", "described", "refuse_unfit", "stepper_of"]

Model = (
    Operator
    | LimitedDrive
    | ScheduledSystem
    | LimitedSchedule
    | TrackingController
    | RepetitiveController
    | StableInverse
    | JointEstimator
    | ScaleEstimator
)


def block_of(model: Model, precision: Precision) -> Block:
    """Give what is exported of a model.

    Parameters
    ----------
    model
        Any operator, a scheduled model or its inverse, either with a limited drive, a tracking or a
        repetitive controller; a stable inverse is refused with the reason.
    precision
        Of the target.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If it is something else, or a constant cannot be written in that precision.
    """
    if isinstance(model, TrackingController):
        return tracking_block(model, precision)
    if isinstance(model, RepetitiveController):
        return repetitive_block(model, precision)
    if isinstance(model, LimitedDrive):
        return limited_block(model, precision)
    if isinstance(model, Scheduled | ScheduledInverse):
        return scheduled_block(model, precision)
    if isinstance(model, LimitedSchedule):
        return limited_schedule_block(model, precision)
    if isinstance(model, StableInverse):
        raise InputError(
            f"a stable inverse looks {model.preview} samples ahead, which a target cannot; compute "
            "the command beforehand with hyst compensate --method noncausal"
        )
    if not isinstance(model, Operator):
        raise _no_model(model)
    return operator_block(model, precision)


def described(model: Model, description: ModelDescription | None) -> ModelDescription:
    """Give the ``description`` asked for, or that of the ``model``.

    Parameters
    ----------
    model, description
        As given to the export.

    Returns
    -------
    ModelDescription

    Raises
    ------
    InputError
        If ``model`` is none.
    """
    if not isinstance(model, Model):
        raise _no_model(model)
    if description is not None or isinstance(model, StableInverse):
        return description or ModelDescription()
    return model.description


def refuse_unfit(model: Model, description: ModelDescription | None, despite_verdict: bool) -> None:
    """Refuse to export a ``model`` that no command should come from, or one so described.

    Parameters
    ----------
    model, description
        As given to the export.
    despite_verdict
        Whether the user wants it nevertheless.

    Raises
    ------
    InputError
        If a verdict is ``unfit`` and the user does not.
    """
    for about in (getattr(model, "description", None), description):
        verdict = about.verdict if isinstance(about, ModelDescription) else None
        refuse_if_unfit(verdict, "nothing is exported", despite_verdict)


def _no_model(found: object) -> InputError:
    name = f"the class {found.__name__}" if isinstance(found, type) else type(found).__name__
    return InputError(
        f"{name} cannot be exported; give an operator, a tracking controller, a joint estimator, "
        "or the model that an estimator has found"
    )

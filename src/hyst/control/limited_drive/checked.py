"""What a limited drive is made of: which signal the drive is, its range and its sample time."""

from __future__ import annotations

from typing import Any, Literal

from hyst.checks.numbers import as_sample_time
from hyst.control.drive_limits import Limits, as_limits
from hyst.errors import InputError
from hyst.operators import ModelDescription, Operator
from hyst.operators.composition import leaves_of

Drive = Literal["input", "output"]

NO_LIMITS = "none"

SIDE_NOT_KNOWN = (
    "the file of the operator, older than version 5, does not say whether it is a model or an "
    "inverse, so it is not known which signal the drive is"
)


def as_drive(drive: Any, operator: Operator, forward: Any) -> Drive:
    """Say which signal of an operator the drive is.

    Parameters
    ----------
    drive
        As given; None for what the descriptions tell.
    operator
        The model or the inverse.
    forward
        As given; only an inverse has one.

    Raises
    ------
    InputError
        If it is neither, or the parts of a composition disagree about it.
    """
    if drive is not None:
        if drive not in ("input", "output"):
            raise InputError(
                f"drive is {drive!r}; give 'input' for a model, 'output' for an inverse"
            )
        return "input" if drive == "input" else "output"
    if forward is not None:
        return "output"
    if operator.description.is_inverse is None:
        raise InputError(
            f"{SIDE_NOT_KNOWN}; start from the file of the model and take its inverse, or say it "
            "by is_inverse in the description"
        )
    if operator.description != ModelDescription():
        return "output" if operator.description.is_inverse else "input"
    parts = [each for each in leaves_of(operator) if not each.is_map and not each.keeps_unit()]
    told = {each.description.is_inverse for each in parts or leaves_of(operator)}
    if len(told) > 1:
        raise InputError(
            "some stages of the operator are inverses and others are not, so it is not known which "
            "signal the drive is; give drive='input' or drive='output'"
        )
    return "output" if told == {True} else "input"


def range_of_drive(
    limits: Any, rate: float | None, about: ModelDescription, drive: Drive
) -> Limits | None:
    """Give the limits of a drive: as given, or its range in the record behind a model.

    Parameters
    ----------
    limits
        Lowest and highest drive, ``"none"``, or None for those of the record.
    rate
        As checked.
    about
        Description of the operator.
    drive
        Which of its signals the drive is.

    Raises
    ------
    InputError
        If they are not two ascending numbers, or not known.
    """
    if isinstance(limits, str) and limits == NO_LIMITS:
        if rate is None:
            raise InputError(
                "limits is 'none' and there is no rate, so nothing is limited; give one"
            )
        return None
    if limits is not None:
        return as_limits(limits)
    low, high = getattr(about, f"{drive}_low"), getattr(about, f"{drive}_high")
    if low is None or high is None:
        if rate is not None:
            return None
        raise InputError(
            "the description of the operator does not tell the range of the drive; give limits, "
            "the lowest and the highest drive"
        )
    return as_limits((low, high))


def sample_time(operator: Operator, dt: Any, rate: float | None) -> float | None:
    """Give the sample time of a limited drive, seconds; None if any will do.

    Parameters
    ----------
    operator
        The model or the inverse.
    dt
        As given; None for that of the operator, or of the record behind it.
    rate
        As checked; it needs a sample time.

    Raises
    ------
    InputError
        If it is none, another one than the operator's, or needed and not known.
    """
    time = None if dt is None else as_sample_time(dt)
    if time is not None:
        operator.require_sample_time(time, "the drive")
        return time
    if operator.dt is not None:
        return operator.dt
    if rate is not None and operator.description.dt is None:
        raise InputError("a rate is counted in samples, whose time is not known; give dt, seconds")
    return operator.description.dt if rate is not None else None

"""What an export is told of the drive: its limits, its rate, its history."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, final

from numpy.typing import ArrayLike

from hyst.checks.numbers import as_number
from hyst.control.drive_limits import Limits, as_limits, as_rate
from hyst.control.limited_drive.checked import Drive, as_drive
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.errors import InputError, NotInvertibleError
from hyst.export.c.drive_range import NO_RANGE
from hyst.export.c.driver_codes import DriverCodes
from hyst.models.scheduled import Scheduled
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.operators import ModelDescription, Operator

System = Scheduled | ScheduledInverse

AUTO, NONE = "auto", "none"

OF_THE_RECORD = "the range of the record"


@final
@dataclass(frozen=True)
class DriveOptions:
    """Limits, rate and history of a drive, as an export is given them.

    Parameters
    ----------
    limits
        ``"auto"`` for the range of the record, None or ``"none"`` for none, or lowest and highest.
    rate
        The most the drive moves in a second; None for any.
    history
        What drove the actuator before the start; None for nothing.
    codes
        Of a driver, whose volts the limits then are; None for a drive in volts.
    history_at
        Second signal during the history; None where there is none.
    """

    limits: Any = AUTO
    rate: float | None = None
    history: ArrayLike | None = None
    codes: DriverCodes | None = None
    history_at: float | None = None

    def __post_init__(self) -> None:
        limits = NONE if self.limits is None else self.limits
        if not isinstance(limits, str):
            limits = as_limits(limits)
        elif limits not in (AUTO, NONE):
            raise InputError(
                f"limits is {limits!r}; give 'auto', 'none', or the lowest and the highest drive"
            )
        object.__setattr__(self, "limits", limits)
        object.__setattr__(self, "rate", as_rate(self.rate))
        if self.history_at is not None:
            if self.history is None:
                raise InputError("history_at is of a history; give one, or leave it out")
            object.__setattr__(self, "history_at", as_number(self.history_at, "history_at"))

    @property
    def are_given(self) -> bool:
        """Whether limits or a rate are asked for."""
        return not isinstance(self.limits, str) or self.rate is not None

    def refuse(self, what: str, instead: str, is_limited: bool) -> None:
        """Refuse limits and rate where there is no use for them.

        Parameters
        ----------
        what, instead
            Why there is none, and what to do.
        is_limited
            Whether there are others, which cannot be taken away.

        Raises
        ------
        InputError
            If they are given.
        """
        if self.are_given or (is_limited and self.limits == NONE):
            name = "rate_limit" if self.rate is not None else "limits"
            raise InputError(f"{what}, so {name} cannot be given; {instead}")


@final
@dataclass(frozen=True)
class Limited:
    """An operator or a scheduled model with its limits, or without and why.

    Parameters
    ----------
    model
        What is exported.
    source
        Where the limits come from, or why there are none.
    """

    model: Operator | LimitedDrive | System | LimitedSchedule
    source: str


def limited(model: Operator, options: DriveOptions, about: ModelDescription) -> Limited:
    """Give an operator as it is exported: with the limits that are asked for.

    Parameters
    ----------
    model
        A model or an inverse.
    options
        As the export is given them.
    about
        The description that the export is given, or else that of the model.

    Returns
    -------
    Limited

    Raises
    ------
    InputError
        If limits or a rate are asked for and cannot be had, or those of the record cannot hold.
    NotInvertibleError
        If the model turns back within the limits.
    """
    if options.limits == NONE and options.rate is None:
        return Limited(model, "none: as asked for")
    try:
        side = as_drive(None, model, None)
    except InputError as unknown:
        if options.are_given:
            raise
        return Limited(model, f"none: {unknown}")
    ends, source = ends_of(options, side, about, model.description)
    if ends is None and options.rate is None:
        return Limited(model, source)
    if side == "output" and not options.are_given and (reason := _no_forward(model)):
        return Limited(model, f"none: {reason}")
    dt = about.dt if options.rate is not None and model.dt is None else None
    limits = NONE if ends is None else ends
    return Limited(LimitedDrive(model, limits, options.rate, dt=dt, drive=side), source)


def limited_schedule(model: System, options: DriveOptions, about: ModelDescription) -> Limited:
    """Give a scheduled model or its inverse as it is exported: with the limits that are asked for.

    Parameters
    ----------
    model, options, about
        As ``limited`` takes them. A driver counts for nothing: no codes are exported.

    Raises
    ------
    InputError
        If limits or a rate are asked for and cannot be had.
    NotInvertibleError
        If the model turns back within the limits at a value of the schedule.
    """
    side: Drive = "input" if isinstance(model, Scheduled) else "output"
    ends, source = ends_of(replace(options, codes=None), side, about, model.description)
    if ends is None and options.rate is None:
        return Limited(model, source)
    dt = about.dt if options.rate is not None and model.dt is None else None
    limits = NONE if ends is None else ends
    return Limited(LimitedSchedule(model, limits, options.rate, dt=dt), source)


def ends_of(
    options: DriveOptions, side: Drive, *told: ModelDescription
) -> tuple[Limits | None, str]:
    """Give the limits that are asked for and where they come from, or None and why.

    Parameters
    ----------
    options
        As the export is given them.
    side
        Which signal the drive is.
    told
        Descriptions; the first that tells a range counts.
    """
    if options.limits == NONE:
        return None, "none: as asked for"
    ends, source = _ends_known(options, side, *told)
    return (ends, source) if options.codes is None else options.codes.within(ends, source)


def _ends_known(
    options: DriveOptions, side: Drive, *told: ModelDescription
) -> tuple[Limits | None, str]:
    if options.limits != AUTO:
        return options.limits, "as given"
    for about in told:
        low, high = getattr(about, f"{side}_low"), getattr(about, f"{side}_high")
        if low is not None and high is not None and low < high:
            return (low, high), OF_THE_RECORD
    return None, NO_RANGE


def _no_forward(inverse: Operator) -> str:
    """Say why the memory of an actuator cannot be followed, if so."""
    try:
        inverse.inverse()
    except NotInvertibleError as reason:
        return f"the memory of a drive that is held could not be followed ({reason})"
    return ""

"""Limits of a drive, and the operator that tells what a drive within them does."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number, as_positive
from hyst.control.block_constants import as_entries
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator

Array = NDArray[np.float64]

Limits = tuple[float, float]

# An exact inverse leaves rounding of the drives tried, some of which pass many stages.
_EXACT = 1e-6


def as_limits(limits: Any) -> Limits | None:
    """Check the limits of a drive.

    Parameters
    ----------
    limits
        Lowest and highest drive, or None.

    Raises
    ------
    InputError
        If they are not two finite ascending numbers.
    """
    if limits is None:
        return None
    try:
        low, high = limits
    except (TypeError, ValueError):
        raise InputError(
            f"limits is {limits!r}; give the lowest and the highest drive, or None"
        ) from None
    ends = as_number(low, "the lowest drive"), as_number(high, "the highest drive")
    if not ends[0] < ends[1]:
        raise InputError(f"limits is {ends}; give the lowest drive first, the highest above it")
    return ends


def as_rate(rate: Any) -> float | None:
    """Check the largest rate of a drive, units per second, or None."""
    return None if rate is None else as_positive(rate, "rate", "units of the drive per second")


def within(limits: Limits | None, drive: float) -> float:
    """Give the nearest drive that is allowed.

    Parameters
    ----------
    limits
        As checked.
    drive
        Any.
    """
    return drive if limits is None else min(max(drive, limits[0]), limits[1])


def stated(limits: Limits | None, rate: float | None, dt: float) -> tuple[float, float, float]:
    """Give lowest drive, highest drive, and most change in a sample, as the core takes them.

    Parameters
    ----------
    limits, rate
        As checked.
    dt
        Sample time, s.

    Returns
    -------
    low, high, change
        Where nothing is limited: the largest numbers there are, and no change, 0.

    Raises
    ------
    InputError
        If the change is none that a number can hold.
    """
    most = sys.float_info.max
    low, high = (-most, most) if limits is None else limits
    change = 0.0 if rate is None else rate * dt
    if rate is not None and not 0.0 < change < most:
        raise InputError(f"rate is {rate:.6g}, {change:.6g} a sample; give one that can be counted")
    return low, high, change


def forward_operator(
    inverse: Operator | None,
    hysteresis: Operator | None,
    limits: Limits | None,
    dt: float | None,
    name: str = "hysteresis",
) -> Operator | None:
    """Give the operator from the drive to v of which ``inverse`` is the exact inverse.

    Parameters
    ----------
    inverse
        From v to the drive; None for the identity.
    hysteresis
        That operator, where it is known; it is tried on drives within the limits.
    limits
        As checked.
    dt
        Sample time of the block, s; None if any will do.
    name
        What messages call the operator that is known.

    Returns
    -------
    Operator or None
        None for the identity.

    Raises
    ------
    InputError
        If there is none, or the one given is none.
    """
    if inverse is None:
        if hysteresis is not None:
            raise InputError("there is no inverse for the hysteresis to belong to; leave it out")
        return None
    if hysteresis is not None:
        _require_cancelling(inverse, hysteresis, limits, dt, name)
        return hysteresis
    try:
        return inverse.inverse()
    except NotInvertibleError as refused:
        raise InputError(
            "a limited drive needs the operator of which the inverse is the exact inverse, and of "
            f"this one it is not known ({refused}); give it as {name}"
        ) from refused


def limited_drive(
    inverse: Operator | None,
    limits: Any,
    rate: Any,
    hysteresis: Operator | None,
    W: ArrayLike | None,
    order: int,
    dt: float,
) -> dict[str, Any]:
    """Check what a block with a limited drive has beside the others.

    Parameters
    ----------
    inverse
        From v to the drive; None for the identity.
    limits, rate, hysteresis, W
        As given to the block.
    order
        Number of its states.
    dt
        Its sample time, s.

    Returns
    -------
    dict
        These by name, checked, and ``forward``, from the drive to v; all None without limits.

    Raises
    ------
    InputError
        If they cannot be used.
    """
    ends, change = as_limits(limits), as_rate(rate)
    told: dict[str, Any] = {"limits": ends, "rate": change, "hysteresis": hysteresis}
    told |= {"W": None, "forward": None}
    if ends is None and change is None:
        if hysteresis is not None or W is not None:
            raise InputError("hysteresis and W belong to limits or a rate; leave them out")
        return told
    if W is None and order > 0:
        raise InputError(
            "a limited drive needs W, what the states take back of what it could not do; give it, "
            "or let from_continuous make the block"
        )
    stated(ends, change, dt)
    told["W"] = as_entries(() if W is None else W, order, "W")
    told["forward"] = forward_operator(inverse, hysteresis, ends, dt)
    return told


def _require_cancelling(
    inverse: Operator, hysteresis: Operator, limits: Limits | None, dt: float | None, name: str
) -> None:
    if not isinstance(hysteresis, Operator):
        raise InputError(f"{name} is {type(hysteresis).__name__}; give an operator or None")
    if dt is not None:
        hysteresis.require_sample_time(dt, "the controller")
    if limits is None:
        raise InputError(f"{name} is tried on drives within the limits; give limits, too")
    u = _drives(*limits)
    try:
        missed = float(np.abs(inverse(hysteresis(u)) - u).max())
    except InputError as refused:
        raise InputError(f"inverse cannot undo {name} within the limits: {refused}") from (refused)
    if missed > _EXACT * (limits[1] - limits[0]):
        raise InputError(
            f"inverse is not the exact inverse of {name}: drives within the limits come back "
            f"up to {missed:.3g} off; give the operator of which it is"
        )


def _drives(low: float, high: float) -> Array:
    """From end to end in loops that get smaller, then from turn to turn at random."""
    rest = within((low, high), 0.0)
    shrinking = 0.9 ** np.arange(40) * np.where(np.arange(40) % 2, -1.0, 1.0)
    turns = np.concatenate([[rest], 0.5 * (low + high) + 0.5 * (high - low) * shrinking])
    turns = np.concatenate([turns, np.random.default_rng(0).uniform(low, high, 40)])
    between = np.arange(8 * turns.size - 7) / 8.0
    return np.asarray(np.interp(between, np.arange(turns.size), turns))

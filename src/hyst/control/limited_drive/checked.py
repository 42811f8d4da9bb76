"""What a limited drive is made of: which signal the drive is, its range and its sample time."""

from __future__ import annotations

import sys
from typing import Any, Literal

import numpy as np

from hyst import _engine
from hyst.checks.numbers import as_sample_time
from hyst.control.drive_limits import Limits, as_limits
from hyst.errors import InputError
from hyst.operators import ModelDescription, Operator
from hyst.operators.composition import leaves_of

Drive = Literal["input", "output"]

NO_LIMITS = "none"

# By how much the ends of what can be asked of a bank are set too far: far more than rounding.
_SPARE = 1e-3


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


def reach_of_bank(chain: _engine.Chain, low: float, high: float) -> tuple[float, float] | None:
    """Give what an inverse's last stage, a bank of plays, can be asked for within limits.

    Below and above it the drive is beyond the limits, whatever the memory, for plays are no farther
    from v than their radii: ``u >= s v - sum_i |p_i| r_i``, s all weights together.

    Parameters
    ----------
    chain
        Of the inverse.
    low, high
        Of the drive; the largest numbers there are for none.

    Returns
    -------
    tuple of float, or None
        Lowest and highest input of the bank, with much more to spare than rounding needs. None
        where the last stage is no bank that rises however many plays move, narrowest first, or
        another one has a memory: then the memory of the model is needed.
    """
    stages = [chain.constants(i) for i in range(len(chain))]
    if not stages or stages[-1]["call"] != "$signal = hyst_pi_step(&$model, $memory, $signal);":
        return None
    if any(each["state_length"] for each in stages[:-1]):
        return None
    bank = stages[-1]
    p, r = np.array(bank["tables"]["p"]), np.array(bank["tables"]["r"])
    slopes = bank["numbers"]["p0"] + np.concatenate([[0.0], np.cumsum(p)])
    if (slopes <= 0.0).any() or (np.diff(r) < 0.0).any():
        return None
    most = sys.float_info.max
    with np.errstate(over="ignore", invalid="ignore"):
        width = (1.0 + _SPARE) * float(np.abs(p) @ r) + _SPARE * (0.5 * high - 0.5 * low)
        ends = (low - width) / slopes[-1], (high + width) / slopes[-1]
    return float(np.clip(ends[0], -most, most)), float(np.clip(ends[1], -most, most))

"""What limits of the drive cost: refuse or tell clipped samples, and limits out of reach."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.rate_dependent.solved_drive import SolvedDrive
from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.errors import InputError

Array = NDArray[np.float64]


def refuse_or_tell(task: RateDependentTask, clipped: NDArray[np.bool_]) -> tuple[str, ...]:
    """Refuse a drive outside its range, or say how much of it was clipped.

    Parameters
    ----------
    task
        With the range and whether clipping is allowed.
    clipped
        Where the drive was clipped, shape (N,).

    Returns
    -------
    tuple of str
        A note, or none if nothing was clipped.

    Raises
    ------
    InputError
        If samples were clipped and the task does not allow that.
    """
    if not clipped.any():
        return ()
    low, high = task.input_range()
    k, count = int(np.argmax(clipped)), int(clipped.sum())
    if not task.clip:
        raise InputError(
            f"y_ref[{k}] = {task.y_ref[k]:.6g} needs an input outside its range {low:.6g} to "
            f"{high:.6g}, the first of {count} such samples; slow the reference down, use "
            "method='trajectory', or choose to clip it"
        )
    return (
        f"{count} of {clipped.size} samples were clipped to the range {low:.6g} to {high:.6g}, the "
        f"first is sample {k}; what this method promises does not hold there",
    )


def held_in_range(task: RateDependentTask, u: Array) -> tuple[Array, int]:
    """Hold a command within its range that a lag before the plays takes beyond it.

    Parameters
    ----------
    task
        With the range of the drive, and whether clipping is allowed.
    u
        Command, shape (N,).

    Returns
    -------
    held : numpy.ndarray
    beyond : int
        Samples that were held.

    Raises
    ------
    InputError
        If there are any and the task does not allow clipping.
    """
    low, high = task.input_range()
    # A map's inverse gives the ends back to rounding.
    slack = 1e-9 * (high - low) if np.isfinite(high - low) else 0.0
    outside = (u < low - slack) | (u > high + slack)
    if outside.any() and not task.clip:
        raise InputError(
            f"the stages before the plays ask for a command from {u.min():.6g} to {u.max():.6g}, "
            f"{int(outside.sum())} samples outside its range {low:.6g} to {high:.6g}; slow the "
            "reference down, or choose to clip it"
        )
    return np.clip(u, low, high), int(outside.sum())


def judge_rate_limit(
    task: RateDependentTask, found: SolvedDrive, change: float, replace: bool
) -> SolvedDrive:
    """Refuse a limit of the rate that is out of reach, or tell it where clipping is allowed.

    Parameters
    ----------
    task
        Plays, state and target.
    found
        A drive within the limits.
    change
        Largest change of the drive per sample; infinite if there is no limit.
    replace
        Whether to take the drive at rest where it leaves less.

    Returns
    -------
    SolvedDrive

    Raises
    ------
    InputError
        If the limit holds the drive at more than half of its steps, or a drive at rest does better,
        and the task does not allow clipping; the rate the reference needs is named.
    """
    if not np.isfinite(change):
        return found
    rest = _at_rest(task)
    left, left_at_rest = _rms(task, found.drive), _rms(task, rest)
    moves = _moves(task, found.drive)
    active = int(np.count_nonzero(moves >= change * (1.0 - 1e-6)))
    # A drive that the limit never holds is not the limit's fault.
    worse = active > 0 and left >= left_at_rest
    if not worse and 2 * active <= moves.size:
        return found
    if not task.clip:
        raise InputError(_rate_out_of_reach(task, change, (active, moves.size), left, left_at_rest))
    note = (
        f"the rate limit is out of reach for this reference: it holds the drive at {active} of "
        f"{moves.size} steps, the rms error of the plays' output is {left:.4g}, that of a drive "
        f"at rest {left_at_rest:.4g}; slow the reference down or raise the limit"
    )
    if worse and replace:
        note += "; the drive at rest is given"
        return dataclasses.replace(found, drive=rest, notes=(*found.notes, note))
    return dataclasses.replace(found, notes=(*found.notes, note))


def _rate_out_of_reach(
    task: RateDependentTask, change: float, held: tuple[int, int], left: float, at_rest: float
) -> str:
    inverse, memory = task.explicit_inverse()
    needed = float(_moves(task, inverse.run(task.target, memory)[0]).max())
    dt = task.plays.dt
    return (
        f"rate_limit = {change / dt:.6g} is out of reach for this reference, which needs up to "
        f"{needed / dt:.4g}: it holds the drive at {held[0]} of {held[1]} steps, the rms error of "
        f"the plays' output is {left:.4g}, that of a drive at rest {at_rest:.4g}; raise the limit, "
        f"slow the reference down {needed / change:.3g} times, or choose to clip it"
    )


def _moves(task: RateDependentTask, drive: Array) -> Array:
    """Give the sizes of all steps of a drive, also that from where its history ends."""
    state = task.state()
    before = state[-2:-1] if state[-1] > 0.0 else drive[:1]
    return np.abs(np.diff(np.concatenate([before, drive])))


def _at_rest(task: RateDependentTask) -> Array:
    """Stay where the drive has been, or where the reference begins."""
    state = task.state()
    if state[-1] > 0.0:
        first = float(state[-2])
    else:
        inverse, memory = task.explicit_inverse()
        first = float(inverse.run(task.target[:1], memory)[0][0])
    return np.full(task.target.size, min(max(first, task.low), task.high))


def _rms(task: RateDependentTask, drive: Array) -> float:
    y, _ = task.plays.run(drive, task.state())
    return float(np.sqrt(np.mean(np.square(y - task.target))))

"""Begin and end a drive at rest, where an amplifier waits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number
from hyst.errors import InputError
from hyst.signals.drive import Drive, Limits
from hyst.signals.waypoints import path

Array = NDArray[np.float64]


def from_rest(
    drive: Drive, rest: float, *, max_rate: float, max_acceleration: float = math.inf
) -> Drive:
    """Ramp from a value at rest to the start of a drive, and back from its end.

    Parameters
    ----------
    drive
        The drive, within the limits itself.
    rest
        Value before and after, input units.
    max_rate
        Largest rate of the ramps, input units per second.
    max_acceleration
        Largest acceleration, input units per second squared; infinity for none. A drive that moves
        when it starts is reached with its own rate, by a run-up before its first sample.

    Returns
    -------
    Drive
        Its first and last sample are ``rest``; the drive's own samples stand in it unchanged, and
        the notes say where.

    Raises
    ------
    InputError
        If the rate is not limited, or the ramps would be longer than 1e8 samples.

    Examples
    --------
    >>> drive = Drive(np.array([2.0, 3.0, 2.0]), 1.0, "triangle")
    >>> from_rest(drive, 0.0, max_rate=1.001).u.tolist()
    [0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0]
    """
    if math.isinf(max_rate):
        raise InputError("max_rate is not given; a ramp from rest needs one")
    rest = as_number(rest, "rest")
    limits = Limits(max_rate, max_acceleration)
    before = _approach(drive.u, rest, drive.dt, limits)
    after = _approach(drive.u[::-1], rest, drive.dt, limits)[::-1]
    u = np.concatenate([before, drive.u, after])
    notes = [
        *drive.notes,
        f"ramps of {before.size} samples from {rest:.6g} and of {after.size} back to it; the drive "
        f"itself is samples {before.size} to {before.size + len(drive) - 1}",
    ]
    ramps = np.concatenate([before, after, [rest]])
    low, high = float(min(drive.u.min(), rest)), float(max(drive.u.max(), rest))
    if ramps.min() < low or ramps.max() > high:
        notes.append(
            f"the run-ups go from {ramps.min():.6g} to {ramps.max():.6g}, beyond the drive's own "
            f"{low:.6g} to {high:.6g}"
        )
    return replace(drive, u=u, notes=tuple(notes))


def _approach(u: Array, rest: float, dt: float, limits: Limits) -> Array:
    """Give the samples from rest to the one before ``u[0]``."""
    speed = float(u[1] - u[0]) if u.size > 1 else 0.0
    largest = max(float(np.abs(u).max()), abs(rest))
    steps = np.empty(0)
    if not math.isinf(limits.max_acceleration):
        # Steps that grow evenly up to the drive's own first one.
        count = max(1, math.ceil(abs(speed) / limits.bend(dt, largest)))
        steps = speed * np.arange(1, count) / count
    start = float(u[0]) - float(steps.sum())
    run_up = start + np.cumsum(np.concatenate([[0.0], steps]))
    if start == rest:
        return run_up[:-1] if steps.size else np.empty(0)
    ramp = path([rest, start], dt, limits)
    return np.concatenate([ramp[:-1], run_up[:-1]]) if steps.size else ramp[:-1]

"""One record, the repetitions in it: cut out where the command lies, equal drives in one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.cli.learn.measured import Measured
from hyst.cli.learn.placing import alike, place_of, shift_of, unlike

Array = NDArray[np.float64]

_SAME_DRIVE = 0.005  # of its range, rms: periods nearer than this are one command, repeated
_ANOTHER = 0.5  # of its range, rms: nothing that was meant to be this command is further off
_LEAST_ALIKE = 0.8  # correlation of a drive that was meant to be this command with it


@dataclass(frozen=True, eq=False)
class MeasuredRepetition:
    """What was measured with one command.

    Parameters
    ----------
    name
        Where it is from.
    u, y
        Drive and output, shape (N,) each; where the command was repeated, their means.
    notes
        What was done.
    noise
        Standard deviation of a sample of ``y``, where periods with the same drive show it.
    """

    name: str
    u: Array
    y: Array
    notes: tuple[str, ...] = ()
    noise: float | None = None


def repetitions_in(
    measured: Measured, command: Array, count: int | None, periodic: bool
) -> list[MeasuredRepetition]:
    """Give the repetitions that a record holds.

    Parameters
    ----------
    measured
        The record.
    command
        The one that was given for the first of them, shape (N,).
    count
        How many there are, as the user says; None if it is to be seen from the length.
    periodic
        Whether the motion goes on without a pause.

    Raises
    ------
    InputError
        If the record is too short, begins or ends within the motion, or holds another drive.
    """
    n, name = command.size, measured.name
    _refuse_short(measured, n, count)
    start, found, notes = _where(measured.record.u, command, count, periodic, name)
    u, y = (_periods(each, start, found, n) for each in (measured.record.u, measured.record.y))
    _refuse_another_motion(name, u, command)
    return _grouped(name, u, y, measured.notes + notes, periodic)


def _refuse_short(measured: Measured, n: int, count: int | None) -> None:
    """Refuse a record without a whole motion, or as many as there should be."""
    size, dt = measured.record.samples, measured.record.dt
    least = n * (count or 1)
    if size >= least:
        return
    several = "" if not count or count == 1 else f" {count} times"
    raise hyst.InputError(
        f"{measured.name} has {size} samples ({size * dt:.4g} s) and the reference{several} "
        f"{least} ({least * dt:.4g} s); record the whole motion"
    )


def _where(
    u: Array, command: Array, count: int | None, periodic: bool, name: str
) -> tuple[int, int, tuple[str, ...]]:
    """Give the sample at which the motion begins, how often it is there, and what is to be told."""
    n = command.size
    if periodic:
        shift = shift_of(u[:n], command, periodic=True)
        found = count or max((u.size - shift % n) // n, 1)
        late = f"began {_late(shift)}, and counts from its start"
        return shift % n, found, (late,) if shift else ()
    found = count or u.size // n
    if u.size == found * n:
        if count is None and found > 1 and not _all_alike(u, command):
            return _placed(u, command, 1)
        shift = shift_of(u[:n], command, periodic=False)
        if shift == 0:
            return 0, found, ()
        raise hyst.InputError(
            f"{name} begins {_late(shift)}, so an end of the motion is not in it; start the record "
            "with the motion, or record longer: hyst finds the command in the drive"
        )
    return _placed(u, command, count or 1)


def _late(shift: int) -> str:
    return f"{abs(shift)} samples {'before' if shift > 0 else 'after'} the command does"


def _placed(u: Array, command: Array, count: int) -> tuple[int, int, tuple[str, ...]]:
    """Find the motion in a longer record, where its drive is the command."""
    start = place_of(u, np.tile(command, count))
    stop = start + count * command.size
    said = f"is longer than the motion, which was found at samples {start} to {stop - 1}"
    return start, count, (said,)


def _periods(signal: Array, start: int, count: int, n: int) -> Array:
    """Give the repetitions, shape (count, N); a single period is closed where it was begun."""
    if start + count * n > signal.size:
        return np.roll(signal[: count * n], -start).reshape(count, n)
    return signal[start : start + count * n].reshape(count, n)


def _all_alike(u: Array, command: Array) -> bool:
    return min(alike(each, command) for each in u.reshape(-1, command.size)) >= _LEAST_ALIKE


def _refuse_another_motion(name: str, u: Array, command: Array) -> None:
    """Refuse a drive that nobody meant to be the command."""
    for each in u:
        off = unlike(each, command)
        if off <= _ANOTHER and alike(each, command) >= _LEAST_ALIKE:
            continue
        raise hyst.InputError(
            f"the drive in {name} is {100.0 * off:.3g} % of its range off the command (rms), so it "
            "is another motion; give the column of the applied drive as --input, in the unit of "
            "the model, and the reference that it was made for"
        )


def _grouped(
    name: str, u: Array, y: Array, notes: tuple[str, ...], periodic: bool
) -> list[MeasuredRepetition]:
    """Put periods with the same drive together: they are one command, measured several times."""
    count = len(u)
    same = [k > 0 and unlike(u[k], u[k - 1]) < _SAME_DRIVE for k in range(count)]
    starts = [k for k in range(count) if not same[k]]
    found = []
    for start, stop in zip(starts, [*starts[1:], count], strict=True):
        which = name if count == 1 else f"{name}, {_which(start, stop)}"
        told = notes if start == 0 else ()
        # The first period of a drive is on its way to the loop that repeats.
        first = start + 1 if periodic and stop - start > 1 else start
        if stop - start > 1:
            told += (_mean_of(stop - first, first > start),)
        noise = _noise(y[first:stop])
        mean_u, mean_y = u[first:stop].mean(axis=0), y[first:stop].mean(axis=0)
        found.append(MeasuredRepetition(which, mean_u, mean_y, told, noise))
    return found


def _which(start: int, stop: int) -> str:
    if stop - start == 1:
        return f"period {start + 1}"
    return f"periods {start + 1} to {stop}"


def _mean_of(kept: int, without_first: bool) -> str:
    if kept == 1:
        return "the last of 2 periods with the same drive"
    return f"the mean of {kept} periods with the same drive{', without the first' * without_first}"


def _noise(y: Array) -> float | None:
    """Give the standard deviation of the mean of periods that differ by noise alone."""
    kept = len(y)
    if kept < 2:
        return None
    scatter = float(np.sum((y - y.mean(axis=0)) ** 2)) / (y.shape[1] * (kept - 1))
    return math.sqrt(scatter / kept)

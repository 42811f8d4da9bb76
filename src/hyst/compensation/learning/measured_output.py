"""What comes back from a repetition, and whether it can be what it should be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.compensation.learning.one_play import left_by_a_play, left_by_a_shift
from hyst.errors import InputError
from hyst.signals import Record

Array = NDArray[np.float64]

_SAME_TIME = 1e-6

_FEWEST = 8
"""Samples of a motion: below, no two bands of a spectrum are told apart."""

_REVERSED = 0.5
"""Of the output's rms: what a negative gain must leave at most for a sign that is reversed."""

_LATEST = 0.125
"""Of a record: a plant that is later than this is not believed."""

_STUCK = 8
"""Samples on end at the extreme reading, from which on a sensor is held to be at its end."""

_SHIFT_GAIN = 0.25
"""Of the power left: a shift that explains a record so much better is believed."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Output and applied input of one repetition.

    Parameters
    ----------
    y, u
        Shape (N,).
    is_told
        Whether the input was given, and is not the command.
    """

    y: Array
    u: Array
    is_told: bool


def as_reference(y_ref: ArrayLike) -> Array:
    """Check a wanted output.

    Parameters
    ----------
    y_ref
        Shape (N,).

    Raises
    ------
    InputError
        If it is not finite, or has too few samples to learn from.
    """
    checked = finite_vector(y_ref, "y_ref")
    if checked.size < _FEWEST:
        raise InputError(
            f"y_ref has {checked.size} samples, too few to learn from; give {_FEWEST} or more"
        )
    return checked


def as_measured(
    y_measured: ArrayLike | Record,
    u_applied: ArrayLike | None,
    command: Array,
    dt: float | None,
) -> Measured:
    """Check what was measured against what was sent.

    Parameters
    ----------
    y_measured
        Shape (N,), or a record of it, whose input is what was applied.
    u_applied
        Shape (N,), the input that was applied; None: the command.
    command
        Shape (N,), what was sent.
    dt
        Sample time of the motion, s; None if not known.

    Raises
    ------
    InputError
        If a length or the sample time differs, or a sample is not finite.
    """
    if isinstance(y_measured, Record):
        if dt is not None and abs(y_measured.dt - dt) > _SAME_TIME * dt:
            raise InputError(
                f"the measured record has dt = {y_measured.dt:.6g} s, the motion {dt:.6g} s; "
                "record at the rate of the command, or resample the record"
            )
        given = y_measured.u if u_applied is None else u_applied
        return as_measured(y_measured.y, given, command, dt)
    y = finite_vector(y_measured, "y_measured")
    _same_length(y, "the measured output", command.size)
    if u_applied is None:
        return Measured(y, command, False)
    u = finite_vector(u_applied, "u_applied")
    _same_length(u, "the applied input", command.size)
    return Measured(y, u, True)


def _same_length(signal: Array, name: str, wanted: int) -> None:
    if signal.size != wanted:
        way = "shorter" if signal.size < wanted else "longer"
        raise InputError(
            f"{name} has {signal.size} samples, the reference {wanted}: it is {way} by "
            f"{abs(wanted - signal.size)}; record from the first sample of the command to its last"
        )


def refuse_at_rest(y: Array, reference: Array, u: Array, noise: float) -> None:
    """Refuse an output that does not move while it should.

    Parameters
    ----------
    y, reference, u
        Measured, wanted, applied, shape (N,).
    noise
        Rms of what does not repeat.

    Raises
    ------
    InputError
        If it does not.
    """
    wanted = float(np.std(reference))
    moved = float(np.std(y))
    if wanted > 0.0 and moved < max(0.02 * wanted, 0.0) and wanted > 3.0 * noise:
        what = (
            "the command does not move either"
            if float(np.ptp(u)) == 0.0
            else (f"the command goes from {u.min():.6g} to {u.max():.6g}")
        )
        raise InputError(
            f"the measured output stays within {float(np.ptp(y)):.4g} where the reference moves "
            f"by {float(np.ptp(reference)):.4g}, while {what}; look at sensor and amplifier, "
            "nothing was learnt"
        )


def refuse_reversed(y: Array, expected: Array) -> None:
    """Refuse a first output that goes down where it is to go up.

    Parameters
    ----------
    y, expected
        Shape (N,).

    Raises
    ------
    InputError
        If it does.
    """
    own, told = y - y.mean(), expected - expected.mean()
    if float(own @ told) < 0.0 and _left_by_gain(expected, y) < _REVERSED**2 * float(np.var(y)):
        raise InputError(
            "the measured output goes down where the model's goes up, and up where it goes down; "
            "turn the sign of the sensor or of the drive (or, if the actuator is late by half a "
            "period, shift the record), nothing was learnt"
        )


def stuck_samples(y: Array, expected: Array) -> NDArray[np.bool_]:
    """Give the samples at which the sensor reads its extreme while the output should move on.

    Parameters
    ----------
    y
        Measured, shape (N,).
    expected
        What was expected, shape (N,).
    """
    stuck = np.zeros(y.size, dtype=bool)
    if float(np.ptp(y)) == 0.0:
        return stuck
    for extreme, sense in ((float(y.max()), 1.0), (float(y.min()), -1.0)):
        at = y == extreme
        if not _longest_run(at) >= _STUCK:
            continue
        beyond = float(np.ptp(expected[at])) > 0.02 * float(np.ptp(y))
        if beyond and float(np.max(sense * (expected[at] - extreme))) > 0.0:
            stuck |= at
    return stuck


def _longest_run(at: NDArray[np.bool_]) -> int:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], at.astype(np.int8), [0]])))
    return int((edges[1::2] - edges[::2]).max(initial=0))


def shift_between(expected: Array, y: Array, most: int, noise: float) -> int:
    """Give by how many samples a record is late against what was expected of it; 0 if that is it.

    A shift is believed if it leaves a quarter of the power of what is unexpected, or less, and that
    is well above the noise.

    Parameters
    ----------
    expected, y
        Shape (N,).
    most
        Largest shift that is looked for, samples.
    noise
        Rms of what does not repeat.
    """
    n = y.size
    most = min(most, n // 2)
    if most < 1:
        return 0
    now = min(_left(expected, y, 0), _left_by_gain(expected, y))
    if now <= 9.0 * noise**2:
        return 0
    size = 2 ** int(np.ceil(np.log2(2 * n)))
    own, told = y - y.mean(), expected - expected.mean()
    both = np.fft.irfft(np.fft.rfft(own, size) * np.conj(np.fft.rfft(told, size)), size)
    lags = np.concatenate([np.arange(most + 1), np.arange(-most, 0)])
    best = int(lags[int(np.argmax(both[lags]))])
    for way in (-1, 1):
        while abs(best + way) <= most and _left(expected, y, best + way) < _left(expected, y, best):
            best += way
    return best if best and _left(expected, y, best) < _SHIFT_GAIN * now else 0


def delay_or_refusal(expected: Array, y: Array, noise: float, has_history: bool) -> int:
    """Give the delay to learn from a first repetition, or refuse one that is shifted.

    Parameters
    ----------
    expected, y
        Shape (N,).
    noise
        Rms of what does not repeat.
    has_history
        Whether there were repetitions before, whose delay is known.

    Returns
    -------
    int
        Samples.

    Raises
    ------
    InputError
        If the record is shifted.
    """
    late = shift_between(expected, y, y.size // 4, noise)
    if late > 0 and not has_history:
        by_a_shift = left_by_a_shift(expected, y, late)
        if left_by_a_play(expected, y) <= by_a_shift:
            return 0  # a hysteresis that the model misses
    if late == 0 or (not has_history and 0 < late <= _LATEST * y.size):
        return late
    samples = f"{abs(late)} sample{'s' if abs(late) > 1 else ''}"
    way = "late" if late > 0 else "early"
    raise InputError(
        f"the measured output is {way} by {samples} against what was to be expected, so that "
        "nothing was learnt; start recording with the first sample of the command, or, if the "
        "plant itself has become so, begin anew with reset(forget=True)"
    )


def _left_by_gain(expected: Array, y: Array) -> float:
    """Power of what a gain and an offset leave."""
    own, told = y - y.mean(), expected - expected.mean()
    way = float(told @ told)
    gain = float(own @ told) / way if way > 0.0 else 0.0
    return float(np.mean((own - gain * told) ** 2))


def _left(expected: Array, y: Array, lag: int) -> float:
    """Power of what a shift leaves, where the two overlap."""
    a, b = (expected[: expected.size - lag], y[lag:]) if lag >= 0 else (expected[-lag:], y[:lag])
    return float(np.mean(((b - b.mean()) - (a - a.mean())) ** 2))

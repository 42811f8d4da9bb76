"""Triangles, first-order reversal curves, stairs and binary sequences."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive, as_sample_time, whole_number
from hyst.errors import InputError
from hyst.signals.drive import Drive, Limits, as_count, require_length
from hyst.signals.waypoints import path

Array = NDArray[np.float64]

# Feedback taps of shift registers of maximal period 2^n - 1, n = 2..20 (Golomb, Shift Register
# Sequences, 1967).
_TAPS = {
    2: (2, 1), 3: (3, 2), 4: (4, 3), 5: (5, 3), 6: (6, 5), 7: (7, 6), 8: (8, 6, 5, 4), 9: (9, 5),
    10: (10, 7), 11: (11, 9), 12: (12, 6, 4, 1), 13: (13, 4, 3, 1), 14: (14, 5, 3, 1),
    15: (15, 14), 16: (16, 15, 13, 4), 17: (17, 14), 18: (18, 11), 19: (19, 6, 2, 1), 20: (20, 17),
}  # fmt: skip


def triangle(
    dt: float,
    amplitude: float,
    rate: float,
    *,
    cycles: int = 2,
    decay: float = 1.0,
    offset: float = 0.0,
    max_acceleration: float = math.inf,
) -> Drive:
    """Go up and down between ``offset + amplitude`` and ``offset - amplitude`` at one rate.

    Parameters
    ----------
    dt
        Sample time, s.
    amplitude
        Half the range, input units.
    rate
        Input units per second; never exceeded.
    cycles
        Number of cycles.
    decay
        Factor of the amplitude from one cycle to the next, 0 < decay <= 1. Below 1 the minor loops
        lie within one another, and the memory of the actuator is wiped out in the end.
    offset
        Middle, input units.
    max_acceleration
        As of ``Limits``.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> triangle(0.5, 1.0, 2.000001, cycles=1).u.tolist()
    [0.0, 1.0, 0.0, -1.0, 0.0]
    """
    time, half = as_sample_time(dt), as_positive(amplitude, "amplitude")
    as_positive(decay, "decay", "a factor", most=1.0)
    peaks = half * decay ** np.arange(as_count(cycles, "cycles"))
    points = np.concatenate([[0.0], np.column_stack([peaks, -peaks]).ravel(), [0.0]]) + offset
    limits = Limits(as_positive(rate, "rate"), max_acceleration)
    u = path(points, time, limits)
    return Drive(u, time, "triangle" if decay == 1.0 else "reversals")


def decaying_triangle(
    dt: float,
    amplitude: float,
    rate: float,
    *,
    cycles: int = 10,
    decay: float = 0.85,
    offset: float = 0.0,
    max_acceleration: float = math.inf,
) -> Drive:
    """Make a triangle whose amplitude falls from cycle to cycle.

    Parameters
    ----------
    dt, amplitude, rate, cycles, decay, offset, max_acceleration
        As of ``triangle``.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> float(decaying_triangle(0.1, 1.0, 1.0, cycles=3, decay=0.5).u.max())
    1.0
    """
    return triangle(
        dt,
        amplitude,
        rate,
        cycles=cycles,
        decay=decay,
        offset=offset,
        max_acceleration=max_acceleration,
    )


def forc(
    dt: float,
    low: float,
    high: float,
    rate: float,
    *,
    curves: int = 20,
    max_acceleration: float = math.inf,
) -> Drive:
    """First-order reversal curves: from the top down to a reversal point and back up, each lower.

    Parameters
    ----------
    dt
        Sample time, s.
    low, high
        Ends of the range, input units; the drive starts at ``low``.
    rate
        Input units per second; never exceeded.
    curves
        Number of reversal points, evenly spaced, the last one at ``low``.
    max_acceleration
        As of ``Limits``.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If ``low`` is not below ``high``, or an argument cannot be used.

    Examples
    --------
    >>> forc(1.0, 0.0, 2.0, 1.0000001, curves=2).u.tolist()
    [0.0, 1.0, 2.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0]
    """
    time = as_sample_time(dt)
    if not low < high:
        raise InputError(f"low is {low} and high is {high}; give low below high")
    reversals = np.linspace(high, low, as_count(curves, "curves") + 1)[1:]
    tops = np.full(reversals.size, float(high))
    points = np.concatenate([[low, high], np.column_stack([reversals, tops]).ravel()])
    u = path(points, time, Limits(as_positive(rate, "rate"), max_acceleration))
    return Drive(u, time, "forc", notes=(f"{reversals.size} reversal curves",))


def staircase(
    dt: float,
    low: float,
    high: float,
    rate: float,
    *,
    steps: int = 10,
    hold: float = 1.0,
    max_acceleration: float = math.inf,
) -> Drive:
    """Climb in steps from ``low`` to ``high`` and down again, resting on each: shows creep.

    Parameters
    ----------
    dt
        Sample time, s.
    low, high
        Ends of the range, input units.
    rate
        Input units per second between steps; never exceeded.
    steps
        Number of steps each way.
    hold
        Rest on each step, s.
    max_acceleration
        As of ``Limits``.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If ``low`` is not below ``high``, or an argument cannot be used.

    Examples
    --------
    >>> staircase(1.0, 0.0, 1.0, 1.0000001, steps=1, hold=2.0).u.tolist()
    [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    """
    time = as_sample_time(dt)
    if not low < high:
        raise InputError(f"low is {low} and high is {high}; give low below high")
    up = np.linspace(low, high, as_count(steps, "steps") + 1)
    points = np.concatenate([up, up[-2::-1]])
    limits = Limits(as_positive(rate, "rate"), max_acceleration)
    u = path(points, time, limits, round(as_positive(hold, "hold") / time))
    return Drive(u, time, "staircase")


def prbs(
    dt: float,
    amplitude: float,
    *,
    register: int = 10,
    clock: int = 1,
    periods: int = 1,
    offset: float = 0.0,
    max_rate: float = math.inf,
    max_acceleration: float = math.inf,
    seed: int = 1,
) -> Drive:
    """Pseudo-random binary sequence of maximal period, ``offset +- amplitude``.

    Two levels determine linear dynamics, but of a hysteresis only one loop: use it for the linear
    part alone.

    Parameters
    ----------
    dt
        Sample time, s.
    amplitude
        Half the distance of the two levels, input units.
    register
        n, length of the shift register, 2 to 20; the period has 2^n - 1 bits.
    clock
        Samples of one bit.
    periods
        How often the period is repeated.
    offset
        Middle, input units.
    max_rate, max_acceleration
        As of ``Limits``; the edges become ramps, which must end within a bit.
    seed
        Start of the register, 1 to 2^n - 1.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If an edge does not fit into a bit, or an argument cannot be used.

    Examples
    --------
    >>> drive = prbs(0.1, 2.0, register=4)
    >>> drive.period, float(drive.u.sum())
    (15, 2.0)
    """
    time, half = as_sample_time(dt), as_positive(amplitude, "amplitude")
    length = whole_number(register, "register", min(_TAPS), max(_TAPS))
    bits = _maximal_sequence(length, whole_number(seed, "seed", 1, 2**length - 1))
    samples = as_count(clock, "clock")
    require_length(bits.size * samples * as_count(periods, "periods"))
    low, high = float(offset) - half, float(offset) + half
    levels = np.repeat(np.where(bits, high, low), samples)
    if math.isfinite(max_rate) or math.isfinite(max_acceleration):
        # An edge that ought to take no time takes one sample.
        limits = Limits(min(max_rate, 4.0 * half / time), max_acceleration)
        levels = _with_ramps(levels, samples, path([low, high], time, limits)[1:])
    u = np.tile(levels, periods)
    return Drive(u, time, "prbs", bits.size * samples)


def _maximal_sequence(register: int, seed: int) -> NDArray[np.bool_]:
    state, bits = seed, np.empty(2**register - 1, dtype=bool)
    for k in range(bits.size):
        bits[k] = state & 1
        feedback = 0
        for tap in _TAPS[register]:
            feedback ^= (state >> (register - tap)) & 1
        state = (state >> 1) | (feedback << (register - 1))
    return bits


def _with_ramps(levels: Array, clock: int, ramp: Array) -> Array:
    """Replace every edge by a ramp at the beginning of its bit, the falling ones mirrored."""
    if ramp.size > clock:
        raise InputError(
            f"an edge takes {ramp.size} samples but a bit has {clock}; raise clock or lower "
            "amplitude"
        )
    low, high = levels.min(), levels.max()
    result, before = levels.copy(), levels[-1]
    for start in range(0, levels.size, clock):
        now = levels[start]
        if now != before:
            result[start : start + ramp.size] = ramp if now == high else low + (high - ramp)
        before = now
    return result

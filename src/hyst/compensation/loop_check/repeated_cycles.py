"""Stretches of a drive that repeats: one frequency, one amplitude, one offset."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.signals import reversals, suggest_dead_band
from hyst.signals.turning_points import SMALLEST_SWING

Array = NDArray[np.float64]

LEAST_CYCLES = 2
LEAST_SAMPLES = 12
"""Of a cycle: three harmonics need them."""

ALIKE = 0.05
"""Of length and swing, by which cycles of one stretch may differ."""

_JITTER = 2  # samples: a turn lies between two of them, and noise moves it
_MOST_MOVED = 0.25  # of a cycle
_SWEPT = 1.5  # samples by which the length of a cycle may grow from the first to the last
_SINE = 0.05  # rms that is left of a sine, over its amplitude
_LEAVES = 6.0  # times that: the sine has ended
_LONGEST_STEP = 0.5 * np.pi  # rad: of what jumps from end to end no loop is seen
_PLACES = 32  # of a cycle, where cycles are held against each other
_SETTLED = 1e-9  # rad at the end of the stretch
_STEPS = 8  # of the fit of a sine, which takes three


@dataclass(frozen=True, eq=False)
class RepeatedCycles:
    """A stretch of a record in which the input repeats.

    Parameters
    ----------
    start, stop
        Samples, the latter excluded: whole cycles.
    frequency
        Cycles a second, Hz.
    low, high
        Turning points of the input.
    cycle
        Shape (stop - start,): which cycle each sample belongs to, from 0.
    phase
        Shape (stop - start,), rad: the input is at ``(low + high)/2 + (high - low)/2 cos(phase)``,
        and falls where the sine of it is positive.
    weight
        Shape (stop - start,): way of the phase that a sample stands for.
    is_sine
        Whether the input is one.
    """

    start: int
    stop: int
    frequency: float
    low: float
    high: float
    cycle: NDArray[np.intp]
    phase: Array
    weight: Array
    is_sine: bool

    @property
    def cycles(self) -> int:
        """How many."""
        return int(self.cycle[-1]) + 1

    @property
    def window(self) -> slice:
        """Give the samples."""
        return slice(self.start, self.stop)


def repeated_cycles(u: Array, dt: float, valid: slice) -> tuple[RepeatedCycles, ...]:
    """Find the stretches in which an input repeats, without what leads into each.

    A stretch begins after one whole stroke, since only then memory knows both ends of the loop.

    Parameters
    ----------
    u
        Input, shape (N,).
    dt
        Sample time, s.
    valid
        Samples that may be used.

    Returns
    -------
    tuple of RepeatedCycles
        Of ``LEAST_CYCLES`` cycles or more, each of ``LEAST_SAMPLES`` samples or more.
    """
    extent = float(np.ptp(u))
    if extent == 0.0:
        return ()
    noise = suggest_dead_band(u)
    turns = reversals(u, max(noise, SMALLEST_SWING * extent))
    found = []
    for first, last in _alike(u, turns, noise):
        inside = [k for k in range(first + 1, last + 1) if valid.start <= turns[k] < valid.stop]
        if len(inside) >= 2 * LEAST_CYCLES:
            each = _stretch(u, dt, turns[inside], valid)
            if each is not None:
                found.append(each)
    return tuple(found)


def _alike(u: Array, turns: NDArray[np.intp], noise: float) -> Iterator[tuple[int, int]]:
    """Give first and last turn of each run of cycles that are like the first of the run."""
    first = 0
    while first + 2 < turns.size:
        length = int(turns[first + 2] - turns[first])
        ends = u[turns[first]], u[turns[first + 1]]
        swing = abs(float(ends[1] - ends[0]))
        # The top of a sine is flat, so that noise of this height moves its turn by so much.
        moved = length * float(np.sqrt(2.0 * noise / swing)) / np.pi
        room = max(_JITTER, ALIKE * length, min(moved, _MOST_MOVED * length))
        last = first + 1
        while last + 1 < turns.size:
            k = last + 1
            as_long = abs(int(turns[k] - turns[k - 2]) - length) <= room
            as_wide = abs(u[turns[k]] - ends[(k - first) % 2]) <= max(ALIKE * swing, noise)
            if not (as_long and as_wide):
                break
            last = k
        if last > first + 1:
            yield first, last
        first = max(last - 1, first + 1)


def _stretch(u: Array, dt: float, turns: NDArray[np.intp], valid: slice) -> RepeatedCycles | None:
    lengths = turns[2:] - turns[:-2]
    if lengths.mean() < LEAST_SAMPLES or _is_swept(lengths):
        return None
    sine = _as_sine(u[turns[0] : turns[-1] + 1], 2.0 * np.pi / float(lengths.mean()))
    if sine is None:
        return _between_turns(u, dt, turns)
    amplitude, centre, rate, begin, left = sine
    # The last turn is known only once it is passed, so the sine may go on beyond it.
    stop = min(int(turns[-1] + lengths.mean() / 2.0), valid.stop)
    phase = begin + rate * np.arange(stop - turns[0])
    last = int(turns[-1] - turns[0])
    off = np.abs(u[turns[0] : stop] - centre - amplitude * np.cos(phase))[last:]
    gone = off > max(_LEAVES * left, 0.2 * _SINE * amplitude)
    kept = last + (int(gone.argmax()) if gone.any() else gone.size)
    count = int(kept * rate / (2.0 * np.pi) + 1e-9)
    if count < LEAST_CYCLES:
        return None
    samples = round(2.0 * np.pi * count / rate)
    cycle = np.minimum((np.arange(samples) * rate / (2.0 * np.pi)).astype(np.intp), count - 1)
    return RepeatedCycles(
        start=int(turns[0]),
        stop=int(turns[0]) + samples,
        frequency=rate / (2.0 * np.pi * dt),
        low=centre - amplitude,
        high=centre + amplitude,
        cycle=cycle,
        phase=phase[:samples],
        weight=np.full(samples, rate),
        is_sine=True,
    )


def _is_swept(lengths: NDArray[np.intp]) -> bool:
    """Tell a slow sweep, whose cycles grow longer or shorter all the time."""
    k = np.arange(lengths.size) - 0.5 * (lengths.size - 1)
    growth = abs(float(np.dot(k, lengths) / np.dot(k, k))) * (lengths.size - 1)
    return growth > max(_SWEPT, ALIKE * float(lengths.mean()))


def _as_sine(u: Array, rate: float) -> tuple[float, float, float, float, float] | None:
    """Give amplitude, centre, rad a sample, first phase and what is left of u; None: no sine."""
    k = np.arange(u.size, dtype=np.float64)
    a = b = c = 0.0
    for step in range(_STEPS):
        cosine, sine = np.cos(rate * k), np.sin(rate * k)
        columns = np.stack([cosine, sine, np.ones(u.size), k * (b * cosine - a * sine)], axis=1)
        scale = np.linalg.norm(columns, axis=0)
        scale[scale == 0.0] = 1.0
        found = np.linalg.lstsq(columns / scale, u, rcond=None)[0] / scale
        a, b, c = (float(each) for each in found[:3])
        rate += float(found[3])
        if rate <= 0.0:
            return None
        if step > 0 and abs(found[3]) * u.size < _SETTLED:
            break
    amplitude = float(np.hypot(a, b))
    begin = -float(np.arctan2(b, a))
    left = float(np.sqrt(np.mean(np.square(u - c - amplitude * np.cos(begin + rate * k)))))
    return (amplitude, c, rate, begin, left) if left <= _SINE * amplitude else None


def _repeats(u: Array, begins: NDArray[np.intp], swing: float) -> bool:
    """Tell whether the input goes the same way in all cycles, and not from turn to turn anyhow."""
    share = np.linspace(0.0, 1.0, _PLACES, endpoint=False)
    places = begins[:-1, None] + share * np.diff(begins)[:, None]
    ways = np.interp(places, np.arange(u.size), u)
    off = float(np.sqrt(np.mean(np.square(ways - ways.mean(axis=0)))))
    return off <= ALIKE * swing


def _between_turns(u: Array, dt: float, turns: NDArray[np.intp]) -> RepeatedCycles | None:
    """Read the phase from the input itself, where it is no sine."""
    count = (turns.size - 1) // 2
    if count < LEAST_CYCLES:
        return None
    turns = turns[: 2 * count + 1]
    start, stop = int(turns[0]), int(turns[-1])
    ends = np.median(u[turns[0::2]]), np.median(u[turns[1::2]])
    low, high = float(min(ends)), float(max(ends))
    if not _repeats(u, turns[0::2], high - low):
        return None
    stroke = np.searchsorted(turns, np.arange(start, stop), side="right") - 1
    falls = (stroke % 2 == 0) == (ends[0] > ends[1])
    x = np.clip((2.0 * u[start:stop] - low - high) / (high - low), -1.0, 1.0)
    phase = np.where(falls, np.arccos(x), 2.0 * np.pi - np.arccos(x))
    step = np.diff(phase)
    step[step < -np.pi] += 2.0 * np.pi  # over the top
    if float(step.max()) > _LONGEST_STEP:
        return None
    # Noise that steps back stands for no way.
    way = 0.5 * np.maximum(np.append(step, step[-1]) + np.append(step[0], step), 0.0)
    return RepeatedCycles(
        start=start,
        stop=stop,
        frequency=count / ((stop - start) * dt),
        low=low,
        high=high,
        cycle=stroke // 2,
        phase=phase,
        weight=way,
        is_sine=False,
    )

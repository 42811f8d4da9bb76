"""Outliers: one to three samples that leave the path of a signal and come back to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.signals import reversals, suggest_dead_band

Array = NDArray[np.float64]
Samples = NDArray[np.intp]

_LONGEST = 3
# Of ten thousand samples with normal noise, neighbours included, hardly one is 6 deviations off.
_DEVIATIONS = 8.0
_LEAST_SHARE_OF_RANGE = 0.01
# An eighth or more of all samples are no outliers but the way of the signal.
_MOST_CANDIDATES = 0.125
_NEAR = 24
_LAG = 10
_GAIN = 4.0
_LEAST_BEND = 2e-3
_LEAST_JUMP = 0.02
_FEWEST_SAMPLES = 24
# Of normal noise of unit variance the second difference has this median and this upper quartile.
_MEDIAN_BEND = 1.652
_QUARTILE_BEND = 2.818


@dataclass(frozen=True, eq=False)
class Spikes:
    """Samples off the path, and by how much.

    Parameters
    ----------
    samples
        Shape (m,), ascending.
    departures
        Shape (m,), from the straight line between their neighbours, in units of the signal.
    """

    samples: Samples
    departures: Array


def spikes_in(signal: Array, cause: Array | None = None, step: float = 0.0) -> Spikes:
    """Find samples that leave the path of their neighbours and come back to it.

    A sample is off the path when neither the line through the two samples before it, nor that
    through the two behind it, nor that between its neighbours, nor its neighbours themselves are
    near it, against what other samples show: so corners, kinks and jumps are on the path. It must
    stick out of the samples around it. A cause that jumps, or bends as sharply, excuses it, and so
    does one that turns where most of them are: friction that breaks loose.

    Parameters
    ----------
    signal
        Shape (N,), finite.
    cause
        What drives the signal, shape (N,); None where nothing is known.
    step
        Of the converter, in units of the signal, 0 if there is none.

    Returns
    -------
    Spikes
    """
    found = np.zeros(signal.size)
    if signal.size >= _FEWEST_SAMPLES:
        spread = _inner_range(signal)
        for length in range(1, _LONGEST + 1):
            for first in _runs_off_the_path(signal, cause, step, spread, length).tolist():
                line = np.linspace(signal[first - 1], signal[first + length], length + 2)[1:-1]
                inside = slice(first, first + length)
                if not np.any(found[inside]):
                    found[inside] = signal[inside] - line
    samples = np.flatnonzero(found)
    return Spikes(samples, found[samples])


def _runs_off_the_path(
    signal: Array, cause: Array | None, step: float, spread: float, length: int
) -> Samples:
    """First samples of runs of one length that no neighbour explains."""
    bends = np.abs(np.diff(signal, n=2))
    noise = float(np.median(bends)) / _MEDIAN_BEND
    least = max(_LEAST_SHARE_OF_RANGE * spread, _DEVIATIONS * noise, 5.0 * step)
    departure = _departures(signal, length)
    first = np.flatnonzero(departure > least)
    if spread == 0.0 or not 0 < first.size <= _MOST_CANDIDATES * signal.size:
        return np.empty(0, dtype=np.intp)
    size = departure[first]
    first += 2
    keep = size > _DEVIATIONS / _QUARTILE_BEND * _bends_nearby(bends, first, length)
    keep &= _sticks_out(signal, first, length, size)
    first, size = first[keep], size[keep]
    if cause is None or first.size == 0:
        return first
    return first[~_excused(cause, first, length, size / spread)]


def _departures(signal: Array, length: int) -> Array:
    """For every run [k, k + length) with two samples on either side: how far off its path it is."""
    count = signal.size - length - 3
    before, after = signal[1 : 1 + count], signal[2 + length : 2 + length + count]
    rise = before - signal[:count]
    fall = after - signal[3 + length : 3 + length + count]
    least = np.full(count, np.inf)
    for place in range(length):
        value = signal[2 + place : 2 + place + count]
        share = (place + 1) / (length + 1)
        for told in (
            before + (place + 1) * rise,
            after + (length - place) * fall,
            before + share * (after - before),
            before,
            after,
        ):
            np.minimum(least, np.abs(value - told), out=least)
    # A run that does not come back to where it left is a jump.
    least[np.abs(after - before) > least / 2.0] = 0.0
    return least


def _bends_nearby(bends: Array, first: Samples, length: int) -> Array:
    """Upper quartile of the second differences before or behind each run, the larger of both."""
    before = np.arange(-_NEAR - 3, -3)
    levels = [
        np.quantile(bends[np.clip(first[:, None] + side, 0, bends.size - 1)], 0.75, axis=1)
        for side in (before, length + 1 - before - 4)
    ]
    larger: Array = np.maximum(levels[0], levels[1])
    return larger


def _sticks_out(signal: Array, first: Samples, length: int, size: Array) -> NDArray[np.bool_]:
    """Whether runs stand out of the four samples on either side, by half their departure.

    Both are taken from the line through the run's neighbours.
    """
    around = np.concatenate((np.arange(-4, 0), np.arange(length, length + 4)))
    inside = np.arange(length)
    before = signal[first - 1]
    slope = (signal[first + length] - before) / (length + 1)
    near = signal[np.clip(first[:, None] + around, 0, signal.size - 1)] - before[:, None]
    run = signal[first[:, None] + inside] - before[:, None]
    near -= slope[:, None] * (around + 1)
    run -= slope[:, None] * (inside + 1)
    # One of the eight may be an outlier itself.
    highest, lowest = np.partition(near, -2, axis=1)[:, -2], np.partition(near, 1, axis=1)[:, 1]
    above, below = run.min(axis=1) - highest, lowest - run.max(axis=1)
    return np.asarray(np.maximum(above, below) > size / 2.0)


def _excused(cause: Array, first: Samples, length: int, size: Array) -> NDArray[np.bool_]:
    """Whether the cause explains runs of these sizes, in shares of the signal's range."""
    spread = float(np.ptp(cause))
    if spread == 0.0:
        return np.zeros(first.size, dtype=bool)
    moves = np.diff(cause / spread, prepend=cause[0] / spread)
    bends = np.abs(np.diff(moves, prepend=0.0))
    jumps = np.abs(moves) > max(_LEAST_JUMP, 6.0 * float(np.median(np.abs(moves))))
    sharp = bends > max(_LEAST_BEND, 6.0 * float(np.median(bends)))
    turns = sharp.copy()
    turns[reversals(cause, suggest_dead_band(cause))] = True
    around = np.clip(first[:, None] + np.arange(-_LAG, length + 3), 0, cause.size - 1)
    excused = np.any(jumps[around], axis=1) | (size <= _GAIN * bends[around].max(axis=1))
    near = np.any(turns[around], axis=1)
    near_by_chance = _share_near(turns, length) * first.size
    if np.count_nonzero(near) > 2.0 * near_by_chance + 2.0:
        excused |= near
    return np.asarray(excused)


def _share_near(events: NDArray[np.bool_], length: int) -> float:
    """Share of the samples that have an event as near as it would excuse a run."""
    total = np.cumsum(np.concatenate(([0], events)))
    last = np.minimum(np.arange(events.size) + length + 3, events.size)
    start = np.maximum(np.arange(events.size) - _LAG, 0)
    return float(np.mean(total[last] > total[start]))


def _inner_range(signal: Array) -> float:
    """Range of the signal without one sample in two hundred at either end."""
    low, high = np.quantile(signal, (0.005, 0.995))
    return float(high - low)

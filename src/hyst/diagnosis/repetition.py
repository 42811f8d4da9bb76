"""Where a record repeats itself, and the noise by which its output does not."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.drive_period import drive_period, repeat_tolerance
from hyst.diagnosis.interpolation import earlier, first_comparable
from hyst.diagnosis.memory_branches import Segment, repeated_segments
from hyst.signals import Record, estimate_noise

Array = NDArray[np.float64]

_FEWEST_SAMPLES = 10
# A period that holds for less of the record than this tells less than single branches do.
_LEAST_PERIODIC = 0.4
# The largest 1 % of the changes are no noise but spikes and corners; of a normal distribution they
# hold 7.5 % of the variance.
_KEPT, _KEPT_VARIANCE = 0.99, 0.9247


@dataclass(frozen=True, eq=False)
class Repetition:
    """Where a record repeats, its memory settled.

    Parameters
    ----------
    segments
        ``(start, stop, lag)``: samples at which drive and memory are as they were a lag ago; lags
        are samples and need not be whole.
    period
        Of the drive, samples; 0 if single branches repeat and not the drive as a whole.
    settled
        ``(start, stop)`` of samples where the drive has that period and the memory that goes with
        it; none without a period.
    """

    segments: tuple[Segment, ...]
    period: float
    settled: tuple[tuple[int, int], ...]

    @property
    def periods(self) -> float:
        """How many settled periods follow one another; 0 without a period."""
        longest = max((stop - start for start, stop in self.settled), default=0)
        return longest / self.period if self.period > 0.0 else 0.0


def noise_by_repetition(record: Record) -> float | None:
    """Measure the noise of an output by what it does not repeat when drive and memory do.

    Where the drive has a period, equal phases of successive periods are compared, after it has
    once been at both its ends; where it has none, branches that begin with the same remembered
    turning levels and run at the same rate. Lags that are no whole samples are interpolated. What
    changes slowly is drift, and is taken out.

    Parameters
    ----------
    record
        Any record.

    Returns
    -------
    float or None
        rms, output units, >= 0; None where nothing repeats. A quantised output that repeats to the
        bit has 0.
    """
    found = repetition_of(record.u)
    return None if found is None else noise_of(found, record)


def repetition_of(u: Array) -> Repetition | None:
    """Find where a drive repeats itself; None if it nowhere does."""
    period = drive_period(u)
    runs = _settled_runs(u, period) if period is not None else []
    covered = sum(stop - start for start, stop in runs)
    if period is not None and covered >= _LEAST_PERIODIC * u.size:
        lag = _best_lag(period, max(stop - start for start, stop in runs))
        first = first_comparable(lag)
        segments = tuple(
            (start + first, stop, lag)
            for start, stop in runs
            if stop - start - first >= _FEWEST_SAMPLES
        )
        return Repetition(segments, period, tuple(runs))
    segments = tuple(repeated_segments(u))
    return Repetition(segments, 0.0, ()) if segments else None


def noise_of(found: Repetition, record: Record) -> float:
    """Give the rms of what an output does not repeat, slow drift taken out."""
    of_u, of_y = [], []
    for start, stop, lag in found.segments:
        change_u, change_y, power = changes(record, start, stop, lag)
        # White noise of both samples; what is slow in either signal is drift.
        scale = 1.0 / math.sqrt(1.0 + power)
        width = round(found.period) if found.period else 2 * change_u.size
        of_u.append(scale * _without_slow(change_u, width))
        of_y.append(scale * _without_slow(change_y, width))
    drive, output = np.concatenate(of_u), np.concatenate(of_y)
    energy = float(drive @ drive)
    if energy > 0.0:
        output = output - (float(drive @ output) / energy) * drive
    return trimmed_rms(output)


def changes(record: Record, start: int, stop: int, lag: float) -> tuple[Array, Array, float]:
    """Give how input and output changed against a lag ago, and the noise power of the latter."""
    begin = start - first_comparable(lag)
    before_u, power = earlier(record.u[begin:stop], lag)
    before_y, _ = earlier(record.y[begin:stop], lag)
    return record.u[start:stop] - before_u, record.y[start:stop] - before_y, power


def trimmed_rms(values: Array) -> float:
    """Root mean square of what is normally distributed, but for a few values that are not."""
    squares = np.sort(np.square(values))
    kept = squares[: max(math.ceil(_KEPT * squares.size), 1)]
    if kept.size == squares.size:
        return math.sqrt(float(kept.mean()))
    return math.sqrt(float(kept.mean()) / _KEPT_VARIANCE)


def _settled_runs(u: Array, period: float) -> list[tuple[int, int]]:
    """Cut out where the drive repeats, each from the sample at which its memory is settled."""
    first = first_comparable(period)
    change = u[first:] - earlier(u, period)[0]
    same = np.abs(change) <= repeat_tolerance(u, change, estimate_noise(u))
    same = _mostly(same, max(3, round(period / 20.0)))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], same.astype(np.int8), [0]])))
    runs = []
    for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        cycle, stop = u[begin : begin + int(np.ceil(period))], end + first
        settled = begin + max(int(np.argmax(cycle)), int(np.argmin(cycle)))
        if stop - settled - first >= max(0.4 * period, _FEWEST_SAMPLES):
            runs.append((settled, stop))
    return runs


def _mostly(true: NDArray[np.bool_], width: int) -> NDArray[np.bool_]:
    """Whether most of the samples around one are true: single ones out of line break no run."""
    if true.size < width:
        return true
    total = np.concatenate([[0], np.cumsum(true)])
    at = np.arange(true.size)
    low, high = np.maximum(at - width // 2, 0), np.minimum(at + width // 2 + 1, true.size)
    most: NDArray[np.bool_] = (total[high] - total[low]) >= 0.8 * (high - low)
    return most


def _best_lag(period: float, longest: int) -> float:
    """One, two or three periods: which is nearest to whole samples and leaves enough to compare."""
    lags = [many * period for many in (1, 2, 3) if many == 1 or 2 * many * period < longest]
    return min(lags, key=lambda lag: round(abs(lag - round(lag)), 2))


def _without_slow(values: Array, width: int) -> Array:
    """Take out a running mean over a period, or a line where there is little more than one."""
    if values.size < 2 * width:
        t = np.linspace(-1.0, 1.0, values.size)
        slope = float(t @ values) / float(t @ t)
        return values - values.mean() - slope * t
    total = np.concatenate([[0.0], np.cumsum(values)])
    at = np.arange(values.size)
    low = np.clip(at - width // 2, 0, values.size - width - 1)
    return values - (total[low + width + 1] - total[low]) / (width + 1)

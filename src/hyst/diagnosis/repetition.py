"""Where a record repeats itself, and the noise by which its output does not."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.drive_period import drive_period, repeat_tolerance
from hyst.diagnosis.finding import NO_SAMPLES
from hyst.diagnosis.interpolation import earlier, first_comparable
from hyst.diagnosis.memory_branches import Segment, repeated_segments
from hyst.signals import Record, estimate_noise

Array = NDArray[np.float64]

_FEWEST_SAMPLES = 10
# A period that holds for less of the record than this tells less than single branches do.
_LEAST_PERIODIC = 0.4
_ENOUGH_PERIODS, _MORE = 4.0, 1.2
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

    @property
    def samples(self) -> int:
        """How many samples have another to be compared with."""
        return sum(stop - start for start, stop, _ in self.segments)


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
    periodic = _periodic(u)
    if periodic is not None and periodic.periods >= _ENOUGH_PERIODS:
        return periodic
    segments = tuple(repeated_segments(u))
    single = Repetition(segments, 0.0, ()) if segments else None
    if periodic is None or single is None:
        return periodic or single
    # A drive of many branches, repeated once or twice, repeats more within itself.
    return single if single.samples > _MORE * periodic.samples else periodic


def _periodic(u: Array) -> Repetition | None:
    """Find where a drive has a period; None if it has none for much of the record."""
    period = drive_period(u)
    runs = _settled_runs(u, period) if period is not None else []
    covered = sum(stop - start for start, stop in runs)
    if period is None or covered < _LEAST_PERIODIC * u.size:
        return None
    lag = _best_lag(period, max(stop - start for start, stop in runs))
    first = first_comparable(lag)
    segments = tuple(
        (start + first, stop, lag)
        for start, stop in runs
        if stop - start - first >= _FEWEST_SAMPLES
    )
    return Repetition(segments, period, tuple(runs)) if segments else None


def noise_of(found: Repetition, record: Record, left_out: NDArray[np.intp] = NO_SAMPLES) -> float:
    """Give the rms of what an output does not repeat, slow drift taken out.

    Parameters
    ----------
    found
        Where the record repeats.
    record
        The record, straight lines over samples that are no measurements.
    left_out
        These samples: no comparison with them counts.
    """
    measured = np.ones(record.samples, dtype=np.bool_)
    measured[left_out[left_out < record.samples]] = False
    of_u, of_y = [], []
    for start, stop, lag in found.segments:
        change_u, change_y, power = changes(record, start, stop, lag)
        # White noise of both samples; what is slow in either signal is drift.
        scale = 1.0 / math.sqrt(1.0 + power)
        width = round(found.period) if found.period else 2 * change_u.size
        counts = _both_measured(measured, start, stop, lag)
        of_u.append(scale * _without_slow(change_u, width)[counts])
        of_y.append(scale * _without_slow(change_y, width)[counts])
    drive, output = np.concatenate(of_u), np.concatenate(of_y)
    energy = float(drive @ drive)
    if energy > 0.0:
        output = output - (float(drive @ output) / energy) * drive
    return trimmed_rms(output)


def _both_measured(
    measured: NDArray[np.bool_], start: int, stop: int, lag: float
) -> NDArray[np.bool_]:
    """Tell where a sample and those a lag before it are measurements; everywhere if nowhere."""
    now = np.arange(start, stop)
    before = np.floor(now - lag).astype(np.intp)
    after = np.ceil(now - lag).astype(np.intp)
    both: NDArray[np.bool_] = measured[now] & measured[before] & measured[after]
    return both if both.any() else np.ones_like(both)


def changes(record: Record, start: int, stop: int, lag: float) -> tuple[Array, Array, float]:
    """Give how input and output changed against a lag ago, and the noise power of what was then.

    Parameters
    ----------
    record
        The record.
    start, stop
        Samples of a segment.
    lag
        Its lag, samples.
    """
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
    rest: Array
    if values.size < 2 * width:
        t = np.linspace(-1.0, 1.0, values.size)
        slope = float(t @ values) / float(t @ t)
        rest = values - values.mean() - slope * t
        return rest
    # A spike must not become a plateau of the running mean.
    middle = float(np.median(values))
    reach = 7.0 * float(np.median(np.abs(values - middle)))
    held = np.clip(values, middle - reach, middle + reach) if reach > 0.0 else values
    total = np.concatenate([[0.0], np.cumsum(held)])
    at = np.arange(values.size)
    low = np.clip(at - width // 2, 0, values.size - width - 1)
    rest = values - (total[low + width + 1] - total[low]) / (width + 1)
    return rest

"""Where a record repeats itself, and what its output does not repeat: noise and drift."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.drive_period import drive_period, repeat_tolerance
from hyst.diagnosis.interpolation import earlier, first_comparable
from hyst.signals import Record, estimate_noise

Array = NDArray[np.float64]

_FEWEST_SAMPLES = 10
# The largest 1 % of the changes are no noise but spikes and corners; of a normal distribution they
# hold 7.5 % of the variance.
_KEPT, _KEPT_VARIANCE = 0.99, 0.9247


@dataclass(frozen=True, eq=False)
class Repetition:
    """Where a record repeats, its memory settled.

    Parameters
    ----------
    period
        Of the drive, samples; need not be whole.
    runs
        ``(start, stop)`` of samples: within each the drive has the period and the memory that
        belongs to it, from the first to the last.
    noise
        rms of the white part of the output that does not repeat, slow drift taken out, output
        units.
    """

    period: float
    runs: tuple[tuple[int, int], ...]
    noise: float

    @property
    def periods(self) -> float:
        """How many periods the longest run holds."""
        return max(stop - start for start, stop in self.runs) / self.period


def noise_by_repetition(record: Record) -> float | None:
    """Measure the noise of an output by what it does not repeat when its drive does.

    Equal phases of successive periods are compared, after the drive has once been at both its
    ends, so that the memory is the same; a period that is no whole number of samples is
    interpolated. What changes slowly from period to period is drift, and is taken out.

    Parameters
    ----------
    record
        Any record.

    Returns
    -------
    float or None
        rms, output units, >= 0; None where the drive does not repeat for half a period at least.
        A quantised output that repeats to the bit has 0.
    """
    found = repetition_of(record)
    return None if found is None else found.noise


def repetition_of(record: Record) -> Repetition | None:
    """Find where a record repeats itself; None if it nowhere does."""
    period = drive_period(record.u)
    if period is None:
        return None
    runs = tuple(_settled_runs(record.u, period))
    if not runs:
        return None
    lag = _best_lag(period, max(stop - start for start, stop in runs))
    noise = _noise(record, runs, period, lag)
    return None if noise is None else Repetition(period, runs, noise)


def _settled_runs(u: Array, period: float) -> list[tuple[int, int]]:
    """Cut out where the drive repeats, each from the sample at which its memory is settled."""
    first = first_comparable(period)
    change = u[first:] - earlier(u, period)[0]
    same = np.abs(change) <= repeat_tolerance(u, change, estimate_noise(u))
    same = _mostly(same, max(3, round(period / 20.0)))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], same.astype(np.int8), [0]])))
    runs = []
    for start, stop in zip(edges[::2] + first, edges[1::2] + first, strict=True):
        begin = max(int(start - first), 0)
        cycle = u[begin : begin + int(np.ceil(period))]
        settled = begin + max(int(np.argmax(cycle)), int(np.argmin(cycle)))
        if stop - settled - first_comparable(period) >= max(0.4 * period, _FEWEST_SAMPLES):
            runs.append((settled, int(stop)))
    return runs


def _mostly(true: NDArray[np.bool_], width: int) -> NDArray[np.bool_]:
    """Whether most of the samples around one are true: single ones out of line break no run."""
    if true.size < width:
        return true
    total = np.concatenate([[0], np.cumsum(true)])
    at = np.arange(true.size)
    low, high = np.maximum(at - width // 2, 0), np.minimum(at + width // 2 + 1, true.size)
    return (total[high] - total[low]) >= 0.8 * (high - low)


def _best_lag(period: float, longest: int) -> float:
    """One, two or three periods: which is nearest to whole samples and leaves enough to compare."""
    lags = [many * period for many in (1, 2, 3) if many == 1 or 2 * many * period < longest]
    return min(lags, key=lambda lag: round(abs(lag - round(lag)), 2))


def _noise(
    record: Record, runs: tuple[tuple[int, int], ...], period: float, lag: float
) -> float | None:
    first = first_comparable(lag)
    changes, power = [], 1.0
    for start, stop in runs:
        if stop - start - first < _FEWEST_SAMPLES:
            continue
        before_u, _ = earlier(record.u[start:stop], lag)
        before_y, power = earlier(record.y[start:stop], lag)
        change_u = record.u[start + first : stop] - before_u
        change_y = record.y[start + first : stop] - before_y
        # Before the drive's share is sought: what is slow is drift in either.
        changes.append((_without_slow(change_u, period), _without_slow(change_y, period)))
    if not changes:
        return None
    of_u = np.concatenate([each[0] for each in changes])
    of_y = np.concatenate([each[1] for each in changes])
    energy = float(of_u @ of_u)
    if energy > 0.0:
        of_y = of_y - (float(of_u @ of_y) / energy) * of_u
    return trimmed_rms(of_y) / math.sqrt(1.0 + power)


def trimmed_rms(values: Array) -> float:
    """Root mean square of what is normally distributed, but for a few values that are not."""
    squares = np.sort(np.square(values))
    kept = squares[: max(math.ceil(_KEPT * squares.size), 1)]
    if kept.size == squares.size:
        return math.sqrt(float(kept.mean()))
    return math.sqrt(float(kept.mean()) / _KEPT_VARIANCE)


def _without_slow(values: Array, period: float) -> Array:
    """Take out what is left of a mean over one period, or a line where there is little more."""
    width = round(period)
    if values.size < 2 * width:
        t = np.linspace(-1.0, 1.0, values.size)
        slope = float(t @ values) / float(t @ t)
        return values - values.mean() - slope * t
    total = np.concatenate([[0.0], np.cumsum(values)])
    at = np.arange(values.size)
    reach = np.minimum(np.minimum(at, values.size - 1 - at), width // 2)
    # Windows that stay even about their sample follow a line to the very end.
    reach = np.where(reach < width // 4, width // 4, reach)
    low, high = np.maximum(at - reach, 0), np.minimum(at + reach + 1, values.size)
    return values - (total[high] - total[low]) / (high - low)

"""How an output drifts, told without a model by what ought to repeat."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.repetition import Repetition, changes
from hyst.signals import Record

Array = NDArray[np.float64]

_PARTS = 4  # of a period that are followed on their own
_FEWEST_SAMPLES = 10


@dataclass(frozen=True)
class Drift:
    """A slow change of the output that the drive does not ask for.

    Parameters
    ----------
    rate
        Mean, output units per second.
    rate_error
        Standard error of it.
    total
        Over the whole record, output units: ``rate`` times its duration.
    early, late
        Rates of the first and of the second half of the time seen; both are the rate where it is
        even.
    straight
        Whether the record shows no difference between the halves.
    pairs
        How many comparisons it rests on, >= 2.
    """

    rate: float
    rate_error: float
    total: float
    early: float
    late: float
    straight: bool
    pairs: int

    @property
    def shown(self) -> bool:
        """Whether it is beyond chance: more standard errors are asked of few comparisons."""
        asked = {2: 60.0, 3: 10.0, 4: 6.0, 5: 5.0}.get(self.pairs, 4.0)
        return abs(self.rate) > asked * self.rate_error


def drift_of(found: Repetition, record: Record) -> Drift | None:
    """Measure the drift of an output; None where too little repeats.

    Means over equal parts of repetitions are followed in time, each kind of part with an offset of
    its own, and one rate is fitted to all of them.

    Parameters
    ----------
    found
        Where the record repeats.
    record
        The record.
    """
    pairs = _pairs(found, record)
    if pairs.shape[0] < 2:
        return None
    middle, lag, change = pairs[:, 0] * record.dt, pairs[:, 1] * record.dt, pairs[:, 2]
    rate, error = _rate(lag, change)
    half = middle <= np.median(middle)
    if half.sum() < 2 or (~half).sum() < 2:
        return Drift(rate, error, rate * record.duration, rate, rate, True, lag.size)
    early, early_error = _rate(lag[half], change[half])
    late, late_error = _rate(lag[~half], change[~half])
    straight = abs(early - late) < 3.0 * math.hypot(early_error, late_error)
    return Drift(rate, error, rate * record.duration, early, late, straight, lag.size)


def _pairs(found: Repetition, record: Record) -> Array:
    """Rows of middle, lag and mean change of the output, samples and output units."""
    gain = _slope(record)
    rows = []
    for start, stop, lag in found.segments:
        for begin, end in _parts(start, stop, found.period):
            change_u, change_y, _ = changes(record, begin, end, lag)
            # What the drive itself moved on is not drift.
            mean = float(change_y.mean()) - gain * float(change_u.mean())
            rows.append((0.5 * (begin + end - lag), lag, mean))
    return np.array(rows).reshape(-1, 3)


def _parts(start: int, stop: int, period: float) -> list[tuple[int, int]]:
    """Cut a long segment into parts of a period; a branch stays whole."""
    if period == 0.0:
        return [(start, stop)]
    length = max(period / _PARTS, _FEWEST_SAMPLES)
    count = max(int((stop - start) / length), 1)
    edges = [start + round(which * (stop - start) / count) for which in range(count + 1)]
    return [each for each in zip(edges[:-1], edges[1:], strict=True) if each[1] > each[0]]


def _rate(lag: Array, change: Array) -> tuple[float, float]:
    """Rate by least squares over the lags, and its standard error from what is left."""
    energy = float(lag @ lag)
    rate = float(lag @ change) / energy
    left = change - rate * lag
    return rate, math.sqrt(float(left @ left) / max(change.size - 1, 1) / energy)


def _slope(record: Record) -> float:
    u, y = record.u - record.u.mean(), record.y - record.y.mean()
    energy = float(u @ u)
    return float(u @ y) / energy if energy > 0.0 else 0.0

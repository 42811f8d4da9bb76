"""How much of an output its input explains, without any model."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import NDArray

Array = NDArray[np.float64]

_PLACES = 12
_FEWEST_SAMPLES = 100
_LAGS = range(17)
_DEVIATIONS = 6.0


@dataclass(frozen=True)
class Relation:
    """What input and direction explain of an output whose samples look like noise.

    Parameters
    ----------
    share
        Of the variance, 0 to 1, corrected for what chance explains.
    by_chance
        Shares up to this one arise from noise alone.
    correlation
        The largest of output and input at any lag, in standard errors.
    """

    share: float
    by_chance: float
    correlation: float

    @property
    def is_none(self) -> bool:
        """Whether nothing of the output comes from the input."""
        return self.share <= self.by_chance and self.correlation < _DEVIATIONS


def relation_of(signal: Array, cause: Array) -> Relation | None:
    """Tell whether a signal that has no memory of its own is noise.

        share = 1 - (N - 1) / (N - K) sum (y - mean of its cell)^2 / sum (y - mean y)^2

    A cell is one of K / 2 ranges of the input, rising or falling; the best of some lags counts.

    Parameters
    ----------
    signal, cause
        Output and input, shape (N,), finite.

    Returns
    -------
    Relation or None
        None where successive samples of the output agree, so that it is no noise, and for fewer
        than 100 samples.
    """
    count = signal.size
    spread, stroke = float(np.ptp(signal)), float(np.ptp(cause))
    if count < _FEWEST_SAMPLES or spread == 0.0 or stroke == 0.0:
        return None
    y = signal / spread
    y = y - y.mean()
    total = float(y @ y)
    if float(y[1:] @ y[:-1]) > 0.5 * total or float(np.diff(y) @ np.diff(y)) < total:
        return None
    x = (cause - cause.min()) / stroke
    place = np.minimum((x * _PLACES).astype(np.intp), _PLACES - 1)
    rising = np.concatenate(([False], x[1:] > x[:-1])).astype(np.intp)
    cell = 2 * place + rising
    share = max(_explained(y[lag:], cell[: count - lag]) for lag in _LAGS)
    # Of noise, cells explain (K - 1) / (N - K) give or take, which the correction takes away.
    by_chance = 6.0 * math.sqrt(2.0 * 2 * _PLACES) / count + 1.0 / count
    return Relation(share, by_chance, _largest_correlation(y, x) * math.sqrt(count))


def _largest_correlation(signal: Array, cause: Array) -> float:
    """Give the largest correlation with the changes of the cause and with itself, at any lag."""
    size = scipy.fft.next_fast_len(2 * signal.size, real=True)
    transform = scipy.fft.rfft(signal - signal.mean(), size)
    largest = 0.0
    for each in (cause - cause.mean(), np.diff(cause, prepend=cause[0])):
        scale = math.sqrt(float(each @ each) * float(signal @ signal))
        products = scipy.fft.irfft(transform * np.conj(scipy.fft.rfft(each, size)), size)
        largest = max(largest, float(np.max(np.abs(products))) / scale)
    return largest


def _explained(signal: Array, cell: NDArray[np.intp]) -> float:
    """Share of the variance between cells, corrected for their number."""
    number = np.bincount(cell)
    used = number > 0
    sums = np.bincount(cell, signal)[used]
    mean = float(signal.mean())
    total = float((signal - mean) @ (signal - mean))
    within = float(signal @ signal) - float(np.sum(sums**2 / number[used]))
    spare = signal.size - int(used.sum())
    return 1.0 - (signal.size - 1) / spare * within / total

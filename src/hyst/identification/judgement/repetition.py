"""The period of a drive that repeats, and what an error does that repeats with it."""

from __future__ import annotations

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from hyst.identification.judgement.regression import chance, correlation_time
from hyst.identification.judgement.remainder import Part

Array = NDArray[np.float64]

SAME_DRIVE = 2e-3
"""Of the input's range, rms: so near are two periods of a drive that repeats."""

FEWEST_IN_A_PERIOD = 8
MOST_TRIED = 12
"""Periods looked at, that nearly repeat."""

FEWEST_AT_A_PHASE = 3
"""Samples, on the average: a period is divided as finely as these allow."""


def period_of(part: Part) -> int:
    """Give the samples of the shortest period after which the drive repeats; 0 if it does not."""
    u = part.u - part.u.mean()
    n, power = u.size, float(u @ u)
    if n < 2 * FEWEST_IN_A_PERIOD or power == 0.0:
        return 0
    transform = np.abs(scipy.fft.rfft(u, scipy.fft.next_fast_len(2 * n, real=True))) ** 2
    alike = np.asarray(scipy.fft.irfft(transform))[: n // 2 + 1]
    alike = alike / (np.arange(n, n - alike.size, -1) / n * power)
    span = float(np.ptp(part.u))
    inner = np.flatnonzero((alike[1:-1] >= alike[:-2]) & (alike[1:-1] >= alike[2:])) + 1
    near = inner[(alike[inner] > 0.8) & (inner >= FEWEST_IN_A_PERIOD)]
    for lag in near[:MOST_TRIED]:
        for period in (lag, lag - 1, lag + 1):
            apart = part.u[period:] - part.u[:-period]
            if float(np.sqrt(np.mean(apart**2))) <= SAME_DRIVE * span:
                return int(period)
    return 0


def repeating(error: Array, places: NDArray[np.intp], period: int, unlikely: float) -> float:
    """Give the sum of squares of what repeats with the drive, or 0 if noise may do it.

    Parameters
    ----------
    error
        Shape (n,).
    places
        Shape (n,), samples of the part they are.
    period
        Of the drive, samples.
    unlikely
        Probability below which noise does not do it.
    """
    phases = min(period, max(error.size // FEWEST_AT_A_PHASE, 1))
    phase = (places % period) * phases // period
    count = np.bincount(phase, minlength=phases)
    mean = np.bincount(phase, error, minlength=phases) / np.maximum(count, 1)
    rest = error - mean[phase]
    whole, scatter = float(error @ error), float(rest @ rest)
    directions = int(np.count_nonzero(count)) - 1
    time, left = correlation_time(rest), error.size - directions - 1
    # Phases near each other share their noise, as samples do: both count less by the same factor.
    independent = max(round(directions / time), 1)
    if chance(whole, scatter, independent, left / time) > unlikely:
        return 0.0
    by_noise = directions * scatter / max(left, 1)
    return max(whole - scatter - by_noise, 0.0)

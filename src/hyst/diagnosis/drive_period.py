"""The period of a drive, which need be no whole number of samples."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.interpolation import earlier, first_comparable
from hyst.signals import estimate_noise

Array = NDArray[np.float64]

_FEWEST_SAMPLES = 16
_MOST_CANDIDATES = 60
_ENOUGH_FOR_SHARES = 20_000
# Drives that repeat only in parts (several amplitudes, a start-up) must do so for this share.
_LEAST_SHARE = 0.2


def drive_period(u: Array) -> float | None:
    """Find after how many samples a drive repeats; None if it does not.

    The smallest lag at which nearly as many samples repeat as at any: the difference function of
    ``u`` with itself (by FFT) gives the candidates, and lags of several periods the fraction.
    """
    if u.size < _FEWEST_SAMPLES or np.ptp(u) == 0.0:
        return None
    difference = _difference(u - u.mean())
    lags = _minima(difference)
    if lags.size == 0:
        return None
    exact = [_vertex(difference, int(lag)) for lag in lags]
    noise = estimate_noise(u)
    shares = np.array([_share(u, lag, noise) for lag in exact])
    best = float(shares.max())
    if best < _LEAST_SHARE:
        return None
    chosen = int(np.flatnonzero(shares >= 0.9 * best)[0])
    return _refined(u, exact[chosen], noise)


def repeat_tolerance(u: Array, change: Array, noise: float) -> float:
    """Give how far a drive may be from itself a period ago.

    Parameters
    ----------
    u
        Shape (N,).
    change
        Against a period ago, shape (m,).
    noise
        Standard deviation of the noise of ``u``.
    """
    spread = 1.4826 * float(np.median(np.abs(change)))
    span = float(np.ptp(u))
    return max(0.01 * span, min(4.0 * min(spread, math.sqrt(2.0) * noise), 0.06 * span))


def _difference(v: Array) -> Array:
    """Mean square difference at lags 0.. over twice the power: 0 the same, 1 unlike."""
    size = 1 << (2 * v.size - 1).bit_length()
    products = np.fft.irfft(_power(v, size), size)[: v.size]
    energy = np.concatenate([[0.0], np.cumsum(v * v)])
    lags = np.arange(int(v.size / 1.5))
    both = energy[v.size - lags] + energy[-1] - energy[lags]
    with np.errstate(invalid="ignore", divide="ignore"):
        result = 1.0 - 2.0 * products[: lags.size] / both
    return np.where(both > 0.0, result, 1.0)


def _power(v: Array, size: int) -> Array:
    """Give the squares of a spectrum, which of a long record must not outlive them."""
    spectrum = np.fft.rfft(v, size)
    power = spectrum.real**2
    power += spectrum.imag**2
    return power


def _minima(difference: Array) -> NDArray[np.intp]:
    """Lags of local minima past the hill around lag 0, the first ones and the lowest ones."""
    away = np.flatnonzero(difference > 0.3)
    if away.size == 0:
        return np.empty(0, dtype=np.intp)
    inner = difference[1:-1]
    low = (inner <= difference[:-2]) & (inner < difference[2:]) & (inner < 0.5)
    lags = np.flatnonzero(low) + 1
    lags = lags[lags > away[0]]
    if lags.size > _MOST_CANDIDATES:
        half = _MOST_CANDIDATES // 2
        lowest = lags[np.argsort(difference[lags], kind="stable")[:half]]
        lags = np.unique(np.concatenate([lags[:half], lowest]))
    return lags


def _vertex(difference: Array, lag: int) -> float:
    """Place of the minimum of the parabola through three lags."""
    left, middle, right = difference[lag - 1 : lag + 2]
    bend = left - 2.0 * middle + right
    if bend <= 0.0:
        return float(lag)
    return lag + min(max(0.5 * float(left - right) / float(bend), -0.5), 0.5)


def _share(u: Array, lag: float, noise: float) -> float:
    """Share of the samples that are as they were a lag ago."""
    first = first_comparable(lag)
    if u.size - first < _FEWEST_SAMPLES // 2:
        return 0.0
    change = (u[first:] - earlier(u, lag)[0])[:: u.size // _ENOUGH_FOR_SHARES + 1]
    return float(np.mean(np.abs(change) <= repeat_tolerance(u, change, noise)))


def _refined(u: Array, period: float, noise: float) -> float:
    """Shift the drive onto itself by 1, 2, 4, ... periods, as long as it still repeats."""
    many = 1
    share = _share(u, period, noise)
    while many * period < u.size / 1.5:
        lag = _shifted(u[-(_ENOUGH_FOR_SHARES + int(many * period) + 4) :], many * period, noise)
        if _share(u, lag, noise) < 0.8 * share or abs(lag - many * period) > 0.05 * period:
            break
        period = lag / many
        many *= 2
    # A drive made sample by sample mostly has whole periods; the estimate rounds to them.
    nearest = round(period)
    return float(nearest) if abs(period - nearest) * many < 0.2 else period


def _shifted(u: Array, lag: float, noise: float) -> float:
    """Find the lag near one at which a drive is most like itself, by Gauss-Newton steps."""
    for _ in range(4):
        window = earlier(u, lag)[0]
        change = u[first_comparable(lag) :] - window
        if change.size < _FEWEST_SAMPLES // 2:
            return lag
        same = np.abs(change) <= 3.0 * repeat_tolerance(u, change, noise)
        slope = np.gradient(window)[same]
        energy = float(slope @ slope)
        if energy == 0.0:
            return lag
        lag -= min(max(float(slope @ change[same]) / energy, -2.0), 2.0)
    return lag

"""Whether a drive repeats after so many samples, and after how many it does if not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_LARGEST_ERROR = 0.05  # rms between periods, of the range: more is no repetition
_LARGEST_SHIFT = 0.005  # between first and last periods, of the range, where noise explains it not
_BY_CHANCE = 3.0  # times the shift that noise of the drive makes
_UNLIKE = 0.5  # of the drive's variance: before a lag at which it differs so much, it is only slow
_AS_GOOD = 4.0  # times the least square difference of all lags
_NEGLIGIBLE = 1e-5  # of the variance: as good as a repetition without noise
_NO_MISS = 1e-3  # samples
_MOST_TRIED = 50


def repeats(periods: Array) -> bool:
    """Tell whether stretches of a drive are periods of it: alike, and the last like the first.

    Noise of the drive differs from stretch to stretch and is averaged out. A period that is wrong
    by a part of a sample moves on from stretch to stretch, which noise does not.

    Parameters
    ----------
    periods
        Shape (count, samples of a period).
    """
    count, span = len(periods), float(np.ptp(periods))
    if count < 2:
        return True
    error = float(np.sqrt(np.mean(np.square(periods - periods.mean(axis=0))) * count / (count - 1)))
    if error > _LARGEST_ERROR * span:
        return False
    if count == 2:
        return bool(np.abs(periods[1] - periods[0]).max() <= _LARGEST_ERROR * span)
    half = count // 2
    shift = _rms(periods[-half:].mean(axis=0) - periods[:half].mean(axis=0))
    by_noise = _rms(np.diff(periods, axis=0)) / np.sqrt(half)
    if shift > max(_LARGEST_SHIFT * span, _BY_CHANCE * by_noise):
        return False
    miss, its_error, moved = _missed(periods)
    return abs(moved) <= _LARGEST_SHIFT * span or abs(miss) <= _BY_CHANCE * its_error


def samples_until_repeated(u: Array, least: int) -> int | None:
    """Give the fewest samples after which a drive repeats; None if it does not.

    Parameters
    ----------
    u
        Shape (N,), the drive once it has settled.
    least
        How many whole periods N must hold.
    """
    longest = u.size // max(least, 2)
    difference = _square_differences(u, longest)
    varied = np.flatnonzero(difference > _UNLIKE * 2.0 * float(u.var()))
    if not varied.size or varied[0] + 1 >= difference.size:
        return None
    first = int(varied[0]) + 1
    candidates = difference[first:]
    limit = _AS_GOOD * float(candidates.min()) + _NEGLIGIBLE * float(u.var())
    padded = np.concatenate([[np.inf], candidates, [np.inf]])
    is_dip = (candidates <= padded[:-2]) & (candidates <= padded[2:]) & (candidates <= limit)
    best, least_miss = None, np.inf
    for each in first + np.flatnonzero(is_dip)[:_MOST_TRIED]:
        lag = int(each)
        count = u.size // lag
        periods = u[: count * lag].reshape(count, lag)
        if count < 2 or not repeats(periods):
            continue
        miss, error, _ = _missed(periods)
        if abs(miss) <= max(_BY_CHANCE * error, _NO_MISS):
            return lag
        if abs(miss) < least_miss:
            best, least_miss = lag, abs(miss)
    return best


def _missed(periods: Array) -> tuple[float, float, float]:
    """Give by how many samples a period is too short, the standard error, and what it makes in all.

    What a shift makes is the slope of the drive, on which noise hardly projects.
    """
    count, half = len(periods), len(periods) // 2
    apart = count - half
    slope = 0.5 * (np.roll(periods.mean(axis=0), -1) - np.roll(periods.mean(axis=0), 1))
    power = max(float(slope @ slope), 1e-300)
    later = periods[-half:].mean(axis=0) - periods[:half].mean(axis=0)
    shift = -float(slope @ later) / power
    rest = _rms(later + shift * slope)
    return shift / apart, rest / np.sqrt(power) / apart, shift * _rms(slope)


def advice_on_period(u: Array, period: int, least: int) -> str:
    """Say after how many samples a drive does repeat, and what to give.

    Parameters
    ----------
    u
        Shape (N,), the drive once it has settled.
    period
        As it was given, samples.
    least
        How many whole periods must be left.
    """
    found = samples_until_repeated(u, least)
    if found is None:
        return (
            f"the input does not repeat after {period} samples, nor after any other number of them "
            f"up to {u.size // max(least, 2)}; leave out period, or drive with a period that is a "
            "whole number of samples and record at least three of them"
        )
    times = max(round(found / period), 1)
    which = "" if times == 1 else f" ({_counted(times)} periods of {found / times:.6g})"
    return (
        f"the input does not repeat after {period} samples but after {found}{which}: give "
        f"period={found} (--period {found})"
    )


def _counted(times: int) -> str:
    words = ("two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
    return words[times - 2] if times - 2 < len(words) else str(times)


def _square_differences(u: Array, longest: int) -> Array:
    """Give the mean of ``(u_k - u_{k+L})^2`` for L from 0 to ``longest``."""
    u = u - u.mean()
    n, size = u.size, 1 << (2 * u.size - 1).bit_length()
    spectrum = np.fft.rfft(u, size)
    products = np.fft.irfft(np.abs(spectrum) ** 2, size)[: longest + 1]
    squares = np.concatenate([[0.0], np.cumsum(u * u)])
    lags = np.arange(longest + 1)
    both = squares[n - lags] + squares[n] - squares[lags]
    return np.asarray(np.maximum(both - 2.0 * products, 0.0) / (n - lags))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))

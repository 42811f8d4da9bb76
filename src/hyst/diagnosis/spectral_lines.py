"""Sines in a signal that stand out of what surrounds them in its spectrum."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_FEWEST_SAMPLES = 64
# Fewer cycles in the record than this are a slow curve and no line.
_FEWEST_CYCLES = 8
_BLOCK = 24  # bins of the spectrum that share a floor
# Over the median of the power around: white noise gets there once in a billion bins.
_OVER_FLOOR = 30.0
# Over all but its own bins nearby: a line is narrow.
_OVER_NEAR = 8.0
_ENOUGH = 1 << 18  # samples; of longer signals the middle is used


@dataclass(frozen=True)
class Line:
    """One sine in a signal.

    Parameters
    ----------
    frequency
        Hz.
    amplitude
        Of the sine, units of the signal.
    """

    frequency: float
    amplitude: float


def lines_of(signal: Array, dt: float, most: int = 5) -> tuple[Line, ...]:
    """Find sines that stand out of the spectrum around them, the strongest first.

    Parameters
    ----------
    signal
        Shape (N,), evenly sampled: a residual, or an output from which its loop was taken.
    dt
        Time between samples, s.
    most
        Lines to find at most.

    Returns
    -------
    tuple of Line
        None for white or smoothly coloured noise. A sine above half the sample rate appears at
        its alias.
    """
    extra = max(signal.size - _ENOUGH, 0)
    rest = np.asarray(signal, dtype=np.float64)[extra // 2 : signal.size - (extra - extra // 2)]
    if rest.size < _FEWEST_SAMPLES or np.ptp(rest) == 0.0:
        return ()
    rest = _without_line(rest)
    smallest = 1e-9 * float(np.abs(rest).max())
    found: list[Line] = []
    for _ in range(most):
        power = _power(rest)
        index = strongest(power)
        if index is None:
            break
        omega, sine = _fitted(rest, _peak(power, index))
        amplitude = math.sqrt(2.0 * float(sine @ sine) / sine.size)
        if amplitude <= smallest:
            break
        found.append(Line(omega / (2.0 * math.pi * dt), amplitude))
        rest = rest - sine
    return tuple(found)


def strongest(power: Array) -> int | None:
    """Give the bin of the strongest narrow peak of a power spectrum; None if there is none."""
    floor = _floor(power)
    ratio = np.zeros_like(power)
    inner = slice(_FEWEST_CYCLES, power.size - 2)
    peak = (power[1:-1] >= power[:-2]) & (power[1:-1] > power[2:])
    ratio[1:-1] = np.where(peak, power[1:-1] / np.maximum(floor[1:-1], _tiny(power)), 0.0)
    candidates = np.flatnonzero(ratio[inner] > _OVER_FLOOR) + _FEWEST_CYCLES
    for index in candidates[np.argsort(-power[candidates], kind="stable")][:10].tolist():
        near = np.concatenate(
            [power[max(index - 10, 1) : index - 3], power[index + 4 : index + 11]]
        )
        if near.size and power[index] > _OVER_NEAR * float(near.max()):
            return int(index)
    return None


def _tiny(power: Array) -> float:
    return float(power.max()) * 1e-30


def _power(signal: Array) -> Array:
    """Power of the spectrum, von Hann's window applied."""
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * (np.arange(signal.size) + 0.5) / signal.size)
    spectrum = np.fft.rfft(window * signal)
    return spectrum.real**2 + spectrum.imag**2


def _floor(power: Array) -> Array:
    """Median of blocks of bins, of the two nearest ones the greater."""
    blocks = max(power.size // _BLOCK, 1)
    kept = power[: blocks * _BLOCK] if power.size >= _BLOCK else power
    medians = np.median(kept.reshape(blocks, -1), axis=1)
    block = np.minimum(np.arange(power.size) // _BLOCK, blocks - 1)
    after = np.arange(power.size) % _BLOCK >= _BLOCK // 2
    other = np.clip(block + np.where(after, 1, -1), 0, blocks - 1)
    return np.maximum(medians[block], medians[other])


def _peak(power: Array, index: int) -> float:
    """Angle per sample of the top of a parabola through the logarithms of three bins."""
    size = 2 * (power.size - 1)
    left, middle, right = np.log(np.maximum(power[index - 1 : index + 2], _tiny(power)))
    bend = float(left - 2.0 * middle + right)
    shift = 0.5 * float(left - right) / bend if bend < 0.0 else 0.0
    return 2.0 * math.pi * (index + shift) / size


def _fitted(signal: Array, omega: float) -> tuple[float, Array]:
    """Fit a sine, its frequency too, by Gauss-Newton steps that stay within a bin."""
    centred = np.arange(signal.size) - 0.5 * (signal.size - 1)
    furthest = math.pi / signal.size
    for _ in range(4):
        cosine, sine = np.cos(omega * centred), np.sin(omega * centred)
        a, b = np.linalg.lstsq(np.column_stack([cosine, sine]), signal, rcond=None)[0]
        wave = a * cosine + b * sine
        slope = centred * (b * cosine - a * sine)
        energy = float(slope @ slope)
        if energy == 0.0:
            break
        step = float(slope @ (signal - wave)) / energy
        omega += min(max(step, -furthest), furthest)
    cosine, sine = np.cos(omega * centred), np.sin(omega * centred)
    a, b = np.linalg.lstsq(np.column_stack([cosine, sine]), signal, rcond=None)[0]
    return omega, a * cosine + b * sine


def _without_line(signal: Array) -> Array:
    t = np.linspace(-1.0, 1.0, signal.size)
    return signal - signal.mean() - (float(t @ signal) / float(t @ t)) * t

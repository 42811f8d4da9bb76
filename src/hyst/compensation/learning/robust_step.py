"""The change of a command from an error: what repeats, through the inverse of what is known.

    dv = Q G^-1 e,   Q = (1 - c N / |E|^2)+ / (1 + doubt^2)

with E the spectrum of the error, N the power of what does not repeat, and doubt the relative
standard error of G: a Wiener filter without phase. It passes what is above the noise, at whichever
frequency that is, and leaves alone what the linear part is not known for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.learning.linear_part import LinearPart

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_BANDS = ((0, 8.0), (1, 4.5), (4, 2.5), (12, 1.8))
"""Bins to either side, and times the noise's power that their mean is clearly above it."""

_DOUBT = 0.5
"""Relative standard error of the linear part at which half of the gain is left."""

_AT_REST, _BEFORE = 0.1, 20.0
"""By what a plant departs from the model before anything is known: at rest, and more of it in a
cycle a sample."""

_PROBE = 0.06
"""Of the correction where little is known: enough to learn there by what it does."""

_TELLING = 25.0
"""Times the noise's power: what an error must have for that."""

_ROUNDING = 1e-9
"""Of the largest line: less is nothing that is known, also where there is no noise."""

_SURE = 0.02
"""Nothing is known better."""

_LEAST = 0.3
"""Of the response at rest: dynamics that pass less are not inverted."""


@dataclass(frozen=True, eq=False)
class Step:
    """A change of what the model is told to give.

    Parameters
    ----------
    dv
        The change, shape (N,), output units.
    dy
        What it is expected to do, shape (N,).
    share
        Of the error's power that repeats and is corrected, 0 to 1.
    """

    dv: Array
    dy: Array
    share: float


def robust_step(
    error: Array,
    linear: LinearPart,
    doubt: tuple[Array, Array],
    noise: float,
    gain: float,
    periodic: bool,
) -> Step:
    """Give the change of the command that an error asks for.

    Parameters
    ----------
    error
        Wanted minus measured, shape (N,).
    linear
        What is known of the plant behind the model's inverse.
    noise
        Rms of what does not repeat.
    gain
        Share of the correction that is made.
    periodic
        Whether the record goes on at its end as at its beginning.
    """
    whole = error if periodic else _closed(error, linear.settling())
    spectrum = np.fft.rfft(whole)
    frequency = np.fft.rfftfreq(whole.size)
    response = linear.at(frequency)
    power = np.abs(spectrum) ** 2
    own_noise = max(noise**2 * error.size, _ROUNDING**2 * float(power.max(initial=0.0)))
    passed = _above_noise(power, own_noise)
    probe = _PROBE * (_mean_around(power, 1) > _TELLING * own_noise)
    own = np.maximum(np.interp(frequency, *doubt), _SURE) ** -2
    prior = (_AT_REST + _BEFORE * frequency) ** -2
    response = (own * response + prior) / (own + prior)
    trust = np.clip(2.0 - 1.0 / np.sqrt(own + prior) / _DOUBT, probe, 1.0)
    passed = passed * trust
    size = np.abs(response)
    passed = passed * size**2 / (size**2 + (_LEAST * size[0]) ** 2)
    change = gain * passed * spectrum / np.where(size > 0.0, response, 1.0)
    dv = np.fft.irfft(change, whole.size)[: error.size]
    dy = np.fft.irfft(change * response, whole.size)[: error.size]
    before, after = float(np.sum(error**2)), float(np.sum((error - dy) ** 2))
    return Step(dv, dy, 1.0 - after / before if before > 0.0 else 0.0)


def _closed(error: Array, settling: int) -> Array:
    """Lead the end of an error back to its beginning, so that the two do not meet in a step."""
    more = min(max(settling, error.size // 8, 16), 2 * error.size)
    fade = 0.5 + 0.5 * np.cos(np.pi * (np.arange(more) + 1.0) / (more + 1.0))
    return np.concatenate([error, error[-1] * fade + error[0] * (1.0 - fade)])


def _above_noise(power: Array, own: float) -> Array:
    """Give the share to pass: of lines far above the noise, and of bands a little above it."""
    shares = np.zeros(power.size)
    for half, clear in _BANDS:
        mean = _mean_around(power, half) / max(own, 1e-300)
        certain = np.clip((mean - 1.0) / (clear - 1.0) - 0.5, 0.0, 1.0)
        shares = np.maximum(shares, certain * (1.0 - 1.0 / np.maximum(mean, 1.0)))
    return shares


def _mean_around(power: Array, half: int) -> Array:
    """Give the mean over bins to either side."""
    total = np.concatenate([[0.0], np.cumsum(power)])
    at = np.arange(power.size)
    first, last = np.maximum(at - half, 0), np.minimum(at + half + 1, power.size)
    return np.asarray((total[last] - total[first]) / (last - first))

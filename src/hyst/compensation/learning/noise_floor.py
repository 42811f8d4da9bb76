"""How large what does not repeat is: the noise of sensor and surroundings."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_QUARTER, _PARTS = 0.25, 2


def noise_in(error: Array) -> float:
    """Estimate the rms of white noise in the error of one repetition.

    From the quieter quarter of the quietest part of the upper half of its spectrum, where a motion
    has least; the power
    of white noise at a frequency is distributed exponentially, whose quartile is -log(3/4) of the
    mean.

    Parameters
    ----------
    error
        Shape (N,).
    """
    if error.size < 32:
        return float(np.sqrt(np.mean(np.diff(error, 2) ** 2) / 6.0)) if error.size > 2 else 0.0
    window = np.hanning(error.size)
    power = np.abs(np.fft.rfft(window * (error - error.mean()))) ** 2
    parts = np.array_split(power[power.size // 2 :], _PARTS)
    level = min(float(np.quantile(part, _QUARTER)) for part in parts) / -np.log1p(-_QUARTER)
    return float(np.sqrt(level / np.sum(window**2)))


def noise_between(first: Array, second: Array) -> float:
    """Give the rms of what differs between two repetitions of one command, of each of them.

    Parameters
    ----------
    first, second
        Outputs, shape (N,).
    """
    return float(np.sqrt(np.mean((first - second) ** 2) / 2.0))

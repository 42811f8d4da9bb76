"""Harmonics of a signal over a phase, and the signal of harmonics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BLOCK = 65_536  # samples whose cosines are held at a time


def harmonics_of(signal: Array, phase: Array, weight: Array, count: int) -> Array:
    """Fit ``mean + sum_n a_n cos(n phase) + b_n sin(n phase)`` by weighted least squares.

    Parameters
    ----------
    signal, phase, weight
        Shape (N,), N >= 2 count + 1; phase in rad.
    count
        How many harmonics.

    Returns
    -------
    numpy.ndarray
        Shape (count, 2): a and b.

    Examples
    --------
    >>> phase = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    >>> found = harmonics_of(3.0 + np.cos(phase) - 2.0 * np.sin(2 * phase), phase, np.ones(12), 2)
    >>> np.abs(found - [[1.0, 0.0], [0.0, -2.0]]).max() < 1e-12
    np.True_
    """
    square, right = np.zeros((2 * count + 1, 2 * count + 1)), np.zeros(2 * count + 1)
    for start in range(0, phase.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        turned = np.multiply.outer(np.arange(1, count + 1), phase[part])
        columns = np.concatenate([np.ones((1, turned.shape[1])), np.cos(turned), np.sin(turned)])
        weighted = columns * weight[part]
        square += weighted @ columns.T
        right += weighted @ signal[part]
    found = np.linalg.solve(square, right)[1:]
    return np.stack([found[:count], found[count:]], axis=1)


def signal_of(harmonics: Array, phase: Array) -> Array:
    """Give ``sum_n a_n cos(n phase) + b_n sin(n phase)``.

    Parameters
    ----------
    harmonics
        Shape (count, 2): a and b.
    phase
        Shape (N,), rad.

    Returns
    -------
    numpy.ndarray
        Shape (N,).
    """
    result = np.zeros(phase.size)
    for n, (a, b) in enumerate(harmonics, 1):
        result += a * np.cos(n * phase) + b * np.sin(n * phase)
    return result

"""Harmonics of a signal over a phase, and the signal of harmonics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BLOCK = 16_384  # samples whose cosines are held at a time


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
        turned = _turned(phase[part], count)
        columns = np.concatenate([np.ones((1, turned.shape[1])), turned.real, turned.imag])
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
    for start in range(0, phase.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        turned = _turned(phase[part], len(harmonics))
        result[part] = harmonics[:, 0] @ turned.real + harmonics[:, 1] @ turned.imag
    return result


def _turned(phase: Array, count: int) -> NDArray[np.complex128]:
    """Give ``exp(i n phase)`` for n from 1, shape (count, N), by products: cosines are slow."""
    turned = np.empty((count, phase.size), dtype=np.complex128)
    turned[0] = np.exp(1j * phase)
    for n in range(1, count):
        np.multiply(turned[n - 1], turned[0], out=turned[n])
    return turned

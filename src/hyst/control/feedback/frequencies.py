"""Frequencies at which a response is looked at, and where on them something is crossed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_AROUND = np.concatenate([-np.geomspace(0.02, 6.0, 14)[::-1], [0.0], np.geomspace(0.02, 6.0, 14)])
_ROUNDS = 12  # each narrows an interval 32 times
_BETWEEN = np.linspace(0.0, 1.0, 33)[:, None]


def frequencies_around(
    features: ComplexArray, highest: float, per_decade: int = 60, beyond: float = 1e3
) -> Array:
    """Give frequencies that miss no resonance: a logarithmic grid, and closer ones near each pole.

    Parameters
    ----------
    features
        Poles and zeros of interest, 1/s.
    highest
        End of the grid, rad/s; infinite for ``beyond`` times the fastest.
    per_decade
        Of the grid.
    beyond
        How far below the slowest and above the fastest the grid goes.

    Returns
    -------
    numpy.ndarray
        Ascending, rad/s.
    """
    sizes = np.abs(features)
    sizes = sizes[sizes > 1e-9 * sizes.max(initial=0.0)]
    if sizes.size == 0:
        sizes = np.array([1.0 if np.isinf(highest) else 0.1 * highest])
    end = float(sizes.max() * beyond) if np.isinf(highest) else highest
    begin = min(float(sizes.min()), end) / beyond
    grid = np.geomspace(begin, end, int(per_decade * np.log10(end / begin)) + 2)
    near = np.abs(features.imag)[:, None] + np.abs(features.real)[:, None] * _AROUND
    near = near[(near > begin) & (near < end)]
    return np.union1d(grid, near)


def crossings(w: Array, value: Callable[[Array], Array]) -> Array:
    """Give the frequencies at which a real function of frequency changes its sign on a grid.

    Parameters
    ----------
    w
        Grid, rad/s, ascending.
    value
        The function.

    Returns
    -------
    numpy.ndarray
        To rounding; ascending.
    """
    at = value(w)
    where = np.flatnonzero((at[:-1] > 0.0) != (at[1:] > 0.0))
    low, high = w[where].copy(), w[where + 1].copy()
    columns = np.arange(where.size)
    for _ in range(_ROUNDS if where.size else 0):
        # Many points at once: a value costs little beside a call.
        tried = low + (high - low) * _BETWEEN
        above = value(tried.ravel()).reshape(tried.shape) > 0.0
        first = np.argmax(above[1:] != above[:-1], axis=0)
        low, high = tried[first, columns], tried[first + 1, columns]
    return np.asarray(0.5 * (low + high))

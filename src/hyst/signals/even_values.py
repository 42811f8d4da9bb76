"""Phases for which the values of a multisine are spread evenly between its ends."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ROUNDS = 100
_FEWER = 2e7  # samples times rounds that are worth their time


def even_phases(wave: Callable[[Array], Array], lines: NDArray[np.intp], phases: Array) -> Array:
    """Change phases until values are spread evenly; no line changes its size.

    In turn the values are replaced by evenly spaced ones of the same order, and the lines by those
    of the wanted size that have the phases of the result.

    Parameters
    ----------
    wave
        Gives one period from its phases.
    lines
        Shape (m,), numbers of the lines.
    phases
        Shape (m,), where to start.

    Returns
    -------
    numpy.ndarray
        Shape (m,).

    Notes
    -----
    Schreiber and Schmitz, Phys. Rev. Lett. 77 (1996), 635-638, with even values in the place of
    measured ones.
    """
    u = wave(phases)
    even = (2.0 * np.arange(u.size) + 1.0) / u.size - 1.0
    for _ in range(int(np.clip(_FEWER / u.size, 20, _ROUNDS))):
        spread = np.empty(u.size)
        spread[np.argsort(u, kind="stable")] = even
        phases = np.angle(np.fft.rfft(spread)[lines])
        u = wave(phases)
    return phases


def unevenness(u: Array) -> float:
    """Give the largest gap between the share of samples below a value and an even share.

    Parameters
    ----------
    u
        Shape (N,), not constant.

    Returns
    -------
    float
        0 if values are spread evenly from lowest to highest, at most 1 (Kolmogorov-Smirnov).
    """
    ordered = np.sort(u)
    share = (ordered - ordered[0]) / (ordered[-1] - ordered[0])
    return float(np.abs(share - (np.arange(u.size) + 0.5) / u.size).max())

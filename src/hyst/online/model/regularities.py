"""Whether errors can be noise: sums over regimes and products of neighbours, over all the past.

Noise has no mean in any regime of the input, and its samples have nothing to do with each other.
Sums over many samples show what is far below the noise of one.
"""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

Array = NDArray[np.float64]

_BINS, _WAYS, _LAGS = 8, 3, 8
CELLS = _BINS * _WAYS
LENGTH = (_BINS - 1) + 2 * CELLS + 1 + (_LAGS + 1)
_LEAST_IN_CELL = 5.0
_FALSE_ALARMS = 1e-4
LEAST_SAMPLES = 100
"""Below, nothing is judged."""


@final
class Regularities:
    """Sums of errors by way of the input (rising, falling, at rest) and level, and over lags."""

    def __init__(self) -> None:
        self.numbers = np.zeros(LENGTH)
        """Edges of levels, sums and counts of cells, samples, products over lags 0, 1, .."""

    def set_levels(self, u: Array) -> None:
        """Take levels at which as many samples lie; sums begin anew."""
        self.numbers[:] = 0.0
        self.numbers[: _BINS - 1] = np.quantile(u, np.arange(1, _BINS) / _BINS)

    def forget(self, lost: float) -> None:
        """Let the past fade."""
        self.numbers[_BINS - 1 :] *= 1.0 - lost

    def add(self, u: Array, error: Array, told: Array) -> None:
        """Take in samples that follow each other."""
        self.numbers[_BINS - 1 :] += self._sums(u, error, told)

    def judge(self, u: Array, error: Array, told: Array) -> tuple[float, float]:
        """Give how far the past and these samples are beyond noise.

        Returns
        -------
        regimes, neighbours : float
            Sums of squares over what one in 10,000 records of noise exceeds; above 1 is no noise.
        """
        sums = self.numbers[_BINS - 1 :] + self._sums(u, error, told)
        mean, count = sums[:CELLS], sums[CELLS : 2 * CELLS]
        products = sums[2 * CELLS + 1 :]
        if sums[2 * CELLS] < LEAST_SAMPLES or not products[0] > 0.0:
            return 0.0, 0.0
        variance = products[0] / sums[2 * CELLS]
        used = count >= _LEAST_IN_CELL
        regimes = float((mean[used] ** 2 / count[used]).sum() / variance)
        lags = float((products[1:] / products[0]) @ (products[1:] / products[0]))
        neighbours = lags * float(sums[2 * CELLS])
        most = chdtri(max(int(used.sum()), 1), _FALSE_ALARMS), chdtri(_LAGS, _FALSE_ALARMS)
        return regimes / float(most[0]), neighbours / float(most[1])

    def _sums(self, u: Array, error: Array, told: Array) -> Array:
        sums = np.zeros(LENGTH - (_BINS - 1))
        if u.size < 2:
            return sums
        level = np.searchsorted(self.numbers[: _BINS - 1], u)
        way = np.sign(np.diff(u, prepend=u[0])).astype(int) + 1
        cell = way * _BINS + level
        known = np.where(told > 0.0, error, 0.0)
        sums[:CELLS] = np.bincount(cell, known, CELLS)
        sums[CELLS : 2 * CELLS] = np.bincount(cell, told, CELLS)
        sums[2 * CELLS] = told.sum()
        for lag in range(_LAGS + 1):
            sums[2 * CELLS + 1 + lag] = known[lag:] @ known[: known.size - lag]
        return sums

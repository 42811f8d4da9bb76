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
_EDGES = 2 * (_BINS - 1)
_BY_LEVEL = _BINS * _WAYS
CELLS = 2 * _BY_LEVEL
LENGTH = _EDGES + 2 * CELLS + 1 + (_LAGS + 1)
_LEAST_IN_CELL = 5.0
_FALSE_ALARMS = 1e-4
LEAST_SAMPLES = 100
"""Below, nothing is judged."""


@final
class Regularities:
    """Sums of errors by way of the input (rising, falling, at rest), and over lags.

    Once by its level, once by its distance from where it turned last.
    """

    def __init__(self) -> None:
        self.numbers = np.zeros(LENGTH)
        """Edges of levels and distances, sums and counts of cells, samples, products over lags."""

    @property
    def samples(self) -> float:
        """How many samples of the past it holds."""
        return float(self.numbers[_EDGES + 2 * CELLS])

    def set_levels(self, u: Array) -> None:
        """Take levels and distances between which as many samples lie; sums begin anew."""
        self.numbers[:] = 0.0
        shares = np.arange(1, _BINS) / _BINS
        self.numbers[:_EDGES] = np.quantile(
            np.stack([u, _distances(u)[1]]), shares, axis=1
        ).T.ravel()

    def forget(self, lost: float) -> None:
        """Let the past fade."""
        self.numbers[_EDGES:] *= 1.0 - lost

    def add(self, u: Array, error: Array, told: Array) -> None:
        """Take in samples that follow each other.

        Parameters
        ----------
        u, error, told
            Shape (N,); told is 0 where there is no error, else 1.
        """
        self.numbers[_EDGES:] += self._sums(u, error, told)

    def judge(self, u: Array, error: Array, told: Array) -> tuple[float, float]:
        """Give how far the past and these samples are beyond noise.

        Parameters
        ----------
        u, error, told
            As for ``add``.

        Returns
        -------
        regimes, neighbours : float
            Sums of squares over what one in 10,000 records of noise exceeds; above 1 is no noise.
        """
        sums = self.numbers[_EDGES:] + self._sums(u, error, told)
        mean, count = sums[:CELLS], sums[CELLS : 2 * CELLS]
        products = sums[2 * CELLS + 1 :]
        if sums[2 * CELLS] < LEAST_SAMPLES or not products[0] > 0.0:
            return 0.0, 0.0
        variance = products[0] / sums[2 * CELLS]
        regimes = 0.0
        for half in (slice(_BY_LEVEL), slice(_BY_LEVEL, CELLS)):
            used = count[half] >= _LEAST_IN_CELL
            sizes = mean[half][used] ** 2 / count[half][used]
            most = float(chdtri(max(int(used.sum()), 1), _FALSE_ALARMS))
            regimes = max(regimes, float(sizes.sum() / variance) / most)
        lags = float((products[1:] / products[0]) @ (products[1:] / products[0]))
        return regimes, lags * float(sums[2 * CELLS]) / float(chdtri(_LAGS, _FALSE_ALARMS))

    def _sums(self, u: Array, error: Array, told: Array) -> Array:
        sums = np.zeros(LENGTH - _EDGES)
        if u.size < 2:
            return sums
        way, distance = _distances(u)
        known = np.where(told > 0.0, error, 0.0)
        for half, values in enumerate((u, distance)):
            edges = self.numbers[half * (_BINS - 1) : (half + 1) * (_BINS - 1)]
            cell = way * _BINS + np.searchsorted(edges, values)
            first = half * _BY_LEVEL
            sums[first : first + _BY_LEVEL] = np.bincount(cell, known, _BY_LEVEL)
            first += CELLS
            sums[first : first + _BY_LEVEL] = np.bincount(cell, told, _BY_LEVEL)
        sums[2 * CELLS] = told.sum()
        for lag in range(_LAGS + 1):
            sums[2 * CELLS + 1 + lag] = known[lag:] @ known[: known.size - lag]
        return sums


def _distances(u: Array) -> tuple[NDArray[np.intp], Array]:
    """Give the way of the input, 0 falling, 1 at rest, 2 rising, and its distance from its turn."""
    step = np.sign(np.diff(u, prepend=u[0]))
    moving = np.maximum.accumulate(np.where(step != 0.0, np.arange(u.size), 0))
    side = step[moving]
    turned = np.flatnonzero(np.diff(side, prepend=side[0]) != 0.0)
    turn = np.zeros(u.size, dtype=np.intp)
    turn[turned] = turned - 1
    return step.astype(np.intp) + 1, np.abs(u - u[np.maximum.accumulate(turn)])

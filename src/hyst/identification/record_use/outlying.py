"""Samples that are far from every model: spikes and dropouts, which least squares would follow.

They are looked for beside a model richer than any family: plays, ramps over the input and over a
play, and a drift. A model's misfit is spread over many samples; what stands apart from all but one
in a hundred of the residuals is none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.play_bank import bank_blocks
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

PLAYS = 12
KNOTS = 5

RAMPED = [0, 1 + PLAYS // 3]
"""Columns with ramps over them: the input and one of the plays."""

FAR = 6.0
"""Robust standard deviations; noise alone goes so far once in half a billion samples."""

APART = 3.0
"""Times the residual that 99 of 100 samples keep within: misfit has no such tail."""

COMMON = 0.99
DEVIATION_OF_NORMAL = 1.4826
"""Standard deviation over the median absolute one."""

MOST_ROUNDS = 4
RIDGE = 1e-12


def rows_to_fit(data: Data) -> Rows | None:
    """Give which samples used are to be fitted and judged by.

    Parameters
    ----------
    data
        The records.

    Returns
    -------
    numpy.ndarray or None
        Shape (samples used,), false for outlying ones; None if there are none.
    """
    y = data.measured()
    regressors = Regressors.of(data)
    kept = np.ones(y.size, dtype=bool)
    for _ in range(MOST_ROUNDS):
        good = ~_apart(regressors.residual(y, kept), kept)
        if (good == kept).all():
            break
        kept = good
    return None if kept.all() else kept


def winsorised(residual: Array) -> Array:
    """Give squared residuals, those that stand apart cut to where they begin to.

    At most one in a hundred is cut, so misfit counts in full.

    Parameters
    ----------
    residual
        Shape (n,).

    Returns
    -------
    numpy.ndarray
        Shape (n,).
    """
    size = np.abs(residual)
    return np.asarray(np.square(np.minimum(size, _limit(size, 1.0))))


def _limit(size: Array, apart: float) -> float:
    spread = DEVIATION_OF_NORMAL * float(np.median(size))
    common = float(np.quantile(size, COMMON, method="inverted_cdf"))
    return max(FAR * spread, apart * common)


def _apart(residual: Array, kept: Rows) -> Rows:
    size = np.abs(residual - np.median(residual[kept]))
    return np.asarray(size > _limit(size, APART))


@dataclass(frozen=True, eq=False)
class Regressors:
    """Columns richer than any family, made block by block: all of them would be 25 records.

    Parameters
    ----------
    data
        The records.
    r
        Shape (n,), radii of plays, input units.
    knots
        Where the ramps over the input, and over one of the plays, begin.
    means
        Shape (m - 1,), of all columns but the constant one.
    """

    data: Data
    r: Array
    knots: tuple[Array, Array]
    means: Array

    @classmethod
    def of(cls, data: Data) -> Regressors:
        """Make those that suit records."""
        r = data.half_range * np.arange(1, PLAYS + 1) / (PLAYS + 1)
        low, high = np.full(2, np.inf), np.full(2, -np.inf)
        for _, bank in bank_blocks(data, r):
            low = np.minimum(low, bank[:, RAMPED].min(axis=0, initial=np.inf))
            high = np.maximum(high, bank[:, RAMPED].max(axis=0, initial=-np.inf))
        knots = tuple(np.linspace(*ends, KNOTS + 2)[1:-1] for ends in zip(low, high, strict=True))
        plain = cls(data, r, (knots[0], knots[1]), np.zeros(PLAYS + 2 + 2 * KNOTS))
        sums = [rows[:, :-1].sum(axis=0) for _, rows in plain._blocks()]
        return replace(plain, means=np.sum(sums, axis=0) / sum(data.lengths()))

    def residual(self, y: Array, kept: Rows) -> Array:
        """Give what the columns, fitted to the samples kept, leave of all.

        Parameters
        ----------
        y
            Shape (samples used,).
        kept
            Shape (samples used,).
        """
        width = self.means.size + 1
        gram, moment = np.zeros((width, width)), np.zeros(width)
        for here, rows in self._blocks():
            chosen = rows[kept[here]]
            gram += chosen.T @ chosen
            moment += chosen.T @ y[here][kept[here]]
        weights, left = _solved(gram, moment), y.copy()
        for here, rows in self._blocks():
            left[here] -= rows @ weights
        return left

    def _blocks(self) -> Iterator[tuple[slice, Array]]:
        half, total = self.data.half_range, sum(self.data.lengths())
        drift = half * np.linspace(-1.0, 1.0, total)
        for here, bank in bank_blocks(self.data, self.r):
            ramps = [
                np.maximum(bank[:, at, None] - knots, 0.0)
                for at, knots in zip(RAMPED, self.knots, strict=True)
            ]
            rows = np.column_stack([bank, *ramps, drift[here]]) - self.means
            yield here, np.column_stack([rows, np.full(len(rows), half)])


def _solved(gram: Array, moment: Array) -> Array:
    """Solve the normal equations, scaled, with a ridge: only what is left counts here."""
    scale = np.sqrt(np.maximum(np.diag(gram), np.finfo(float).tiny))
    normal = gram / np.outer(scale, scale) + RIDGE * np.eye(scale.size)
    return np.asarray(np.linalg.solve(normal, moment / scale) / scale)

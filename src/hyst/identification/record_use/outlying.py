"""Samples that are far from every model: spikes and dropouts, which least squares would follow.

They are looked for beside a model richer than any family: plays, ramps over the input and over a
play, and a drift. A model's misfit is spread over many samples; what stands apart from all but one
in a hundred of the residuals is none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.play_bank import bank_matrix
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

PLAYS = 12
KNOTS = 5

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
    regressors = _regressors(data)
    kept = np.ones(y.size, dtype=bool)
    for _ in range(MOST_ROUNDS):
        residual = y - regressors @ _least_squares(regressors[kept], y[kept])
        good = ~_apart(residual, kept)
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


def _least_squares(matrix: Array, y: Array) -> Array:
    """Solve the normal equations, scaled, with a ridge: only what is left counts here."""
    gram, moment = matrix.T @ matrix, matrix.T @ y
    scale = np.sqrt(np.maximum(np.diag(gram), np.finfo(float).tiny))
    normal = gram / np.outer(scale, scale) + RIDGE * np.eye(scale.size)
    return np.asarray(np.linalg.solve(normal, moment / scale) / scale)


def _regressors(data: Data) -> Array:
    r = data.half_range * np.arange(1, PLAYS + 1) / (PLAYS + 1)
    bank = bank_matrix(data, r)
    drift = data.half_range * np.linspace(-1.0, 1.0, len(bank))
    columns = [bank, _ramps(bank[:, 0]), _ramps(bank[:, 1 + PLAYS // 3]), drift]
    matrix = np.column_stack(columns)
    matrix = matrix - matrix.mean(axis=0)
    return np.column_stack([matrix, np.full(len(bank), data.half_range)])


def _ramps(signal: Array) -> Array:
    knots = np.linspace(signal.min(), signal.max(), KNOTS + 2)[1:-1]
    return np.asarray(np.maximum(signal[:, None] - knots, 0.0))

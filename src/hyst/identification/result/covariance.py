"""Standard errors that take the autocorrelation of the residual into account."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def robust_covariance(
    jacobian: Array,
    residual: Array,
    lengths: Sequence[int],
    prior: Array | None = None,
    taken_out: int = 0,
) -> Array:
    """Estimate the covariance of least squares estimates with autocorrelated residuals.

    ``(J'J)^-1 S (J'J)^-1 N / (N - m)`` with S the Bartlett-weighted sum of the autocovariances of
    the scores ``J_k e_k``. White residuals give the usual covariance. With prior rows P, whose
    square was added to the cost, ``A^-1 (S + s^2 P'P) A^-1``, A = J'J + P'P, s^2 the variance of
    the residual: what the prior filled is as unsure as the prior is.

    Parameters
    ----------
    jacobian
        Shape (N, m), full rank but for the prior.
    residual
        Shape (N,), of the records.
    lengths
        Samples of each record, in order; correlation does not reach across records.
    prior
        Shape (q, m).
    taken_out
        Directions that were projected out of both: they are estimates as well.

    Returns
    -------
    numpy.ndarray
        Shape (m, m).

    Notes
    -----
    Newey and West, Econometrica 55 (1987), 703-708; bandwidth from a first-order autoregression of
    the residual, Andrews, Econometrica 59 (1991), 817-858, eq. 6.2. The prior's part: Wahba, J. R.
    Stat. Soc. B 45 (1983), 133-150; such errors hold bias as well as scatter, on average.
    """
    every = jacobian if prior is None else np.concatenate([jacobian, prior])
    scale = np.linalg.norm(every, axis=0)
    scaled = jacobian / scale
    bandwidth = _bandwidth(residual, lengths)
    middle = np.zeros((scale.size, scale.size))
    start = 0
    for length in lengths:
        rows = slice(start, start + length)
        middle += _bartlett_sum(scaled[rows] * residual[rows, None], bandwidth)
        start += length
    gram = scaled.T @ scaled
    if prior is None:
        inverse, count = np.linalg.inv(gram), float(scale.size)
    else:
        held = (prior / scale).T @ (prior / scale)
        inverse = np.linalg.inv(gram + held)
        count = float(np.sum(inverse * gram))
        middle += float(residual @ residual) / residual.size * held
    correction = residual.size / max(residual.size - count - taken_out, 1.0)
    covariance = inverse @ middle @ inverse * correction
    return np.asarray(covariance / np.outer(scale, scale))


def _bandwidth(residual: Array, lengths: Sequence[int]) -> int:
    """Choose the number of lags, at most a quarter of the shortest record."""
    before = np.ones(residual.size, dtype=bool)
    before[np.cumsum(lengths) - 1] = False
    now, after = residual[:-1][before[:-1]], residual[1:][before[:-1]]
    power = float(residual @ residual)
    rho = float(np.clip(now @ after / power, -0.99, 0.99)) if power > 0.0 else 0.0
    alpha = 4.0 * rho**2 / ((1.0 - rho) ** 2 * (1.0 + rho) ** 2)
    lags = 1.1447 * (alpha * residual.size) ** (1.0 / 3.0)
    return int(np.clip(np.ceil(lags), 1, max(min(lengths) // 4, 1)))


def _bartlett_sum(scores: Array, bandwidth: int) -> Array:
    """Sum the autocovariances with weights 1 - |lag| / bandwidth.

    The sum over all windows of ``bandwidth`` samples of (window sum)(window sum)' is exactly that,
    times the bandwidth, and needs one matrix product instead of one for each lag.
    """
    padding = np.zeros((bandwidth, scores.shape[1]))
    total = np.cumsum(np.concatenate([padding, scores, padding]), axis=0)
    windows = total[bandwidth:] - total[:-bandwidth]
    return np.asarray(windows.T @ windows / bandwidth)

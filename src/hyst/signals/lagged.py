"""Normal equations and QR factors of the regressors u_k, u_{k-1}, .., u_{k-mu}.

The matrix itself is never formed: a record of ten million samples needs no more memory than itself.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BLOCK = 8192


def lagged_gram(u: Array, y: Array, order: int) -> tuple[Array, Array]:
    """Sum the inner products of the columns ``u_{k-i}``, i = 0..mu, and 1, over k = mu..N-1.

    Each entry follows from its neighbour up and to the left by the two products at the ends of the
    record, so only the first row is summed over the record.

    Parameters
    ----------
    u
        Shape (N,).
    y
        Shape (N,), what is to be explained.
    order
        mu < N.

    Returns
    -------
    gram : numpy.ndarray
        Shape (mu + 2, mu + 2); the last row and column belong to the constant.
    moment : numpy.ndarray
        Shape (mu + 2,).
    """
    n, width = u.size, order + 2
    gram, moment = np.empty((width, width)), np.empty(width)
    lags = range(order + 1)
    row = np.array([u[order:] @ u[order - lag : n - lag] for lag in lags])
    moment[:-1] = [y[order:] @ u[order - lag : n - lag] for lag in lags]
    gram[0, :-1] = row
    entering, leaving = u[:order][::-1], u[n - 1 - order :][::-1]
    for i in range(order):
        gram[i + 1, 0] = gram[0, i + 1]
        gram[i + 1, 1:-1] = gram[i, :-2] + entering[i] * entering - leaving[i] * leaving[:-1]
    total = float(u[order:].sum())
    sums = [total]
    for lag in lags[1:]:
        total += u[order - lag] - u[n - lag]
        sums.append(total)
    gram[-1, :-1] = gram[:-1, -1] = sums
    gram[-1, -1] = n - order
    moment[-1] = y[order:].sum()
    return gram, moment


def lagged_factor(u: Array, y: Array, order: int) -> Array:
    """Give the triangular QR factor of the columns ``u_{k-i}``, i = 0..mu, 1 and y.

    Parameters
    ----------
    u, y, order
        As ``lagged_gram``.

    Returns
    -------
    numpy.ndarray
        Shape (mu + 3, mu + 3), upper triangular.
    """
    width = order + 3
    factor: Array = np.zeros((0, width))
    windows = np.lib.stride_tricks.sliding_window_view(u, order + 1)[:, ::-1]
    for start in range(0, len(windows), _BLOCK):
        rows = windows[start : start + _BLOCK]
        outputs = y[order + start : order + start + len(rows)]
        block = np.column_stack([rows, np.ones(len(rows)), outputs])
        factor = np.asarray(np.linalg.qr(np.concatenate([factor, block]), mode="r"))
    return np.concatenate([factor, np.zeros((max(width - len(factor), 0), width))])

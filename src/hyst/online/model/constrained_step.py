"""The step that fits best within linear inequalities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

Array = NDArray[np.float64]

_LEAST_SHARE = 1e-15
_ROUNDING = 1e-12


def constrained_step(information: Array, pull: Array, rows: Array, least: Array) -> Array:
    """Give d that minimizes ``d' A d / 2 - b' d`` under ``rows d >= least``.

    The optimum is the free one, projected onto the inequalities in the metric A: what has been
    measured is changed least. Directions without information stay.

    Parameters
    ----------
    information, pull
        A, shape (m, m), symmetric, positive semidefinite; b, shape (m,).
    rows, least
        Shape (k, m) and (k,); d = 0 satisfies them.

    Returns
    -------
    numpy.ndarray
        Shape (m,); zeros if nothing else is found.

    Notes
    -----
    Lawson and Hanson, Solving Least Squares Problems (1974), ch. 23: least distance programming by
    non-negative least squares.

    Examples
    --------
    >>> constrained_step(np.eye(2), np.array([-2.0, 1.0]), np.array([[1.0, 0.0]]), np.array([-1.0]))
    array([-1.,  1.])
    """
    values, vectors = np.linalg.eigh(information)
    kept = values > _LEAST_SHARE * max(float(values[-1]), 0.0)
    if not kept.any():
        return np.zeros_like(pull)
    turn = vectors[:, kept] / np.sqrt(values[kept])
    free = turn.T @ pull
    seen = rows @ turn
    size = np.linalg.norm(seen, axis=1)
    here = size > 0.0
    if not here.any():
        return np.asarray(turn @ free)
    seen, wanted = seen[here] / size[here, None], least[here] / size[here]
    missing = wanted - seen @ free
    if (missing <= _ROUNDING).all():
        return np.asarray(turn @ free)
    target = np.zeros(free.size + 1)
    target[-1] = 1.0
    # The last row decides which inequalities bind; one scale of all of it changes nothing.
    scale = float(np.abs(missing).max())
    matrix = np.vstack([seen.T, missing / scale])
    try:
        multipliers, _ = nnls(matrix, target)
    except RuntimeError:
        return np.zeros_like(pull)
    residual = matrix @ multipliers - target
    if not residual[-1] < 0.0:
        return np.zeros_like(pull)
    return np.asarray(turn @ (free - scale * residual[:-1] / residual[-1]))

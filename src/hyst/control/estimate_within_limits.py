"""What an observer estimates while the drive is limited."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst import _engine

Array = NDArray[np.float64]

Matrices = tuple[Array, Array, Array, Array, Array, Array, Array, float]


def estimate_within_limits(
    block: _engine.TrackingController,
    state: Array,
    matrices: Matrices,
    signals: tuple[Array, Array],
) -> Array:
    """Give ``d_hat = E x + F [y_ref, y] + G (v_a - v)``.

    Written in terms of v_a, as ``x+ = (A - W C) x + (B - W D) [y_ref, y] + W v_a``, the linear part
    is stable by itself, whatever C and observer are together.

    Parameters
    ----------
    block
        That gave the drive.
    state
        Its state before the first sample, which is used up.
    matrices
        A, B, C, D, E, F, W and G.
    signals
        y_ref and y, shape (N,) each.

    Returns
    -------
    numpy.ndarray
        Shape (N,).
    """
    A, B, C, D, E, F, W, G = matrices
    y_ref, y = signals
    x, nothing = state[: C.size].copy(), np.zeros(C.size)
    v, excess = np.empty_like(y), np.empty_like(y)
    block.tell(state, y_ref, y, v, excess)
    A = A - np.outer(W, C)
    of_signals = _linear(A, B - np.outer(W, D), E - G * C, F - G * D)
    of_applied = _linear(A, np.column_stack([W, nothing]), E - G * C, np.array([G, 0.0]))
    d_hat, other = np.empty_like(y), np.empty_like(y)
    of_signals.run(x, y_ref, y, d_hat)
    of_applied.run(nothing, v, v, other)
    return d_hat + other


def _linear(A: Array, B: Array, C: Array, D: Array) -> _engine.TrackingController:
    columns, b = A.T.ravel().tolist(), B.T.ravel().tolist()
    none = _engine.Chain(())
    return _engine.TrackingController(columns, b, C.tolist(), float(D[0]), float(D[1]), none)

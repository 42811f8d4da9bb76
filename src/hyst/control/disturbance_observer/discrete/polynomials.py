"""From polynomials in the w-plane to gains of the sampled observer.

With ``u = s / scale`` and ``z = 1 + 2 scale t`` the bilinear map is ``u = t / (1 + scale t)``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def mapped_polynomial(coefficients: Array, scale: float) -> Array:
    """Give ``(1 + scale t)^n p(t / (1 + scale t))``, p of degree n with these coefficients."""
    n = coefficients.size - 1
    result = np.zeros(n + 1)
    rest = np.ones(1)
    # From the highest power down: each has one factor 1 + scale t more.
    for i, value in enumerate(coefficients):
        result += value * np.concatenate([rest, np.zeros(n - i)])
        rest = np.convolve(rest, [scale, 1.0])
    return result


def injection(A: Array, C: Array, coefficients: Array) -> Array:
    """Solve ``C adj(tI - A) L = coefficients`` (degree below n, after a leading 0) for L."""
    n = A.shape[0]
    characteristic = np.real(np.poly(A))
    row, rows = C[0], [C[0]]
    for k in range(1, n):
        row = row @ A + characteristic[k] * C[0]
        rows.append(row)
    matrix = np.array(rows)
    # Powers of slow and of fast poles: rows and columns of all sizes.
    down = np.ones(n)
    across = np.ones(n)
    for _ in range(6):
        down /= np.sqrt(np.maximum(np.abs(matrix * across * down[:, None]).max(axis=1), 1e-300))
        across /= np.sqrt(np.maximum(np.abs(matrix * across * down[:, None]).max(axis=0), 1e-300))
    solved = np.linalg.solve(matrix * across * down[:, None], coefficients[1:] * down)
    return np.asarray(solved * across)

"""Stable polynomials by logarithms: every point of the parameters is a stable one.

Parameters are a, b of each factor ``s^2 + e^a s + e^b``, then c of ``s + e^c`` if the degree is
odd. All stable polynomials have this form.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Roots = NDArray[Any]


def polynomial(parameters: Array) -> tuple[Array, Array]:
    """Give the coefficients (n + 1,), highest power first, and their derivatives (n, n + 1)."""
    n = parameters.size
    a, b, c = _split(np.exp(parameters), n)
    factors = [np.array([1.0, p, q]) for p, q in zip(a, b, strict=True)]
    factors += [np.array([1.0, p]) for p in c]
    x = np.array([1.0])
    for each in factors:
        x = np.convolve(x, each)
    slopes = np.zeros((n, n + 1))
    for i, factor in enumerate(factors):
        rest = np.array([1.0])
        for j, other in enumerate(factors):
            if j != i:
                rest = np.convolve(rest, other)
        if factor.size == 3:
            slopes[2 * i, n - rest.size : n] = factor[1] * rest
            slopes[2 * i + 1, n + 1 - rest.size :] = factor[2] * rest
        else:
            slopes[2 * len(a), n + 1 - rest.size :] = factor[1] * rest
    return x, slopes


def parameters_of(roots: Roots) -> Array:
    """Give the parameters of stable roots."""
    pairs = [(-2.0 * p.real, abs(p) ** 2) for p in roots if p.imag > 0.0]
    real = np.sort(-roots[roots.imag == 0.0].real)
    for i in range(0, real.size - 1, 2):
        pairs.append((real[i] + real[i + 1], real[i] * real[i + 1]))
    values = [each for pair in pairs for each in pair]
    if real.size % 2:
        values.append(real[-1])
    return np.log(np.maximum(values, 1e-12))


def bounds(n: int, slow: float, fast: float) -> tuple[Array, Array]:
    """Bounds of n parameters for roots of sizes between e^slow and e^fast, a little apart."""
    pairs = 2 * (n // 2)
    lowest, highest = np.full(n, slow), np.full(n, fast)
    lowest[1:pairs:2] *= 2.0
    highest[1:pairs:2] *= 2.0
    return lowest, highest


def slowed(parameters: Array, fast: float) -> Array:
    """Take parameters of roots of which some are faster than e^fast to where none is.

    Both roots of ``s^2 + A s + B`` lie within f if ``B <= f^2`` and ``A <= f + B / f``.
    """
    slower, pairs = np.minimum(parameters, np.inf), 2 * (parameters.size // 2)
    slower[1:pairs:2] = np.minimum(slower[1:pairs:2], 2.0 * fast)
    slower[pairs:] = np.minimum(slower[pairs:], fast)
    most = fast + np.log1p(np.exp(slower[1:pairs:2] - 2.0 * fast))
    slower[0:pairs:2] = np.minimum(slower[0:pairs:2], most)
    return slower


def _split(values: Array, n: int) -> tuple[Array, Array, Array]:
    pairs = 2 * (n // 2)
    return values[0:pairs:2], values[1:pairs:2], values[pairs:]

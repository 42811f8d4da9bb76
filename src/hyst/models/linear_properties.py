"""Poles, zeros and values of a state space with one input and one output."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import refuse_overflow
from hyst.errors import NotInvertibleError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_NEGLIGIBLE = 1e-12
_BLOCK = 2_000_000  # numbers held at a time while values are computed


def poles_of(A: Array) -> Complex:
    """Give the eigenvalues of A, the largest modulus first."""
    poles = np.linalg.eigvals(A).astype(np.complex128)
    return poles[np.argsort(-np.abs(poles), kind="stable")]


def answers_after(A: Array, B: Array, C: Array, D: float) -> int:
    """Give the relative degree: the first of ``D, CB, CAB, ..`` that is not zero to rounding.

    The order plus one if all of them are. A, B, C and D are the matrices of the state space.
    """
    scale = max(abs(D), float(np.linalg.norm(B) * np.linalg.norm(C)))
    if abs(D) > _NEGLIGIBLE * scale:
        return 0
    column = B
    for samples in range(1, B.size + 1):
        if abs(float(C @ column)) > _NEGLIGIBLE * scale:
            return samples
        column = A @ column
    return B.size + 1


def zeros_of(A: Array, B: Array, C: Array, D: float) -> Complex:
    """Give the finite zeros, the largest modulus first.

    They are the eigenvalues of ``A - B C'/D'``, where C' and D' belong to the system moved ahead by
    its relative degree, without the zeros at 0 that the move has added.
    """
    ahead = answers_after(A, B, C, D)
    if ahead > B.size:
        return np.empty(0, dtype=np.complex128)
    row, first = C, D
    for _ in range(ahead):
        row, first = row @ A, float(row @ B)
    return poles_of(A - np.outer(B, row) / first)[: B.size - ahead]


def causal_inverse(
    A: Array, B: Array, C: Array, D: float, late: int
) -> tuple[Array, Array, Array, float]:
    """Give ``(A - B C/D, B/D, -C/D, 1/D)`` of the state space A, B, C, D.

    Parameters
    ----------
    A, B, C, D
        Matrices of the state space.
    late
        Samples until its output answers, with its delay.

    Returns
    -------
    tuple
        The matrices of the inverse.

    Raises
    ------
    NotInvertibleError
        If the output does not answer at once, a zero does not lie inside the unit circle, or a
        constant overflows.
    """
    hint = "use hyst.models.StableInverse, which looks ahead, on whole trajectories"
    if late > 0:
        raise NotInvertibleError(
            f"the output answers {late} samples late, so no causal inverse follows at once; {hint}"
        )
    zeros = zeros_of(A, B, C, D)
    if zeros.size and np.abs(zeros[0]) >= 1.0:
        raise NotInvertibleError(
            f"the zero {zeros[0]:.6g} does not lie inside the unit circle, so the causal inverse "
            f"is unstable; {hint}"
        )
    with np.errstate(all="ignore"):
        inverse = A - np.outer(B, C) / D, B / D, -C / D, float(1.0 / np.float64(D))
    refuse_overflow(*inverse)
    return inverse


def settling_samples(A: Array) -> int:
    """Give the samples until the impulse response of a stable A has died out, at most a million."""
    slowest = float(np.abs(poles_of(A)[0])) if A.size else 0.0
    # Repeated poles decay later than their modulus says: twice as long, and a margin.
    decay = 80.0 / -math.log(slowest) if slowest > 0.0 else 0.0
    return int(min(decay, 1e6)) + len(A) + 64


def values_at(points: Complex, A: Array, B: Array, C: Array, D: float) -> Complex:
    """Give ``C (z I - A)^-1 B + D`` at complex points z, shape (m,), from A, B, C and D."""
    result = np.full(points.size, D, dtype=np.complex128)
    n = B.size
    block = max(1, _BLOCK // max(n, 1) ** 2)
    for start in range(0, points.size if n else 0, block):
        part = points[start : start + block]
        matrices = part[:, None, None] * np.eye(n) - A
        columns = np.broadcast_to(B[:, None], (part.size, n, 1))
        result[start : start + block] += np.linalg.solve(matrices, columns)[..., 0] @ C
    return result

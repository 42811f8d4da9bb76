"""Several transfer functions of one denominator as one system, pole by pole.

A companion form moves a pole of multiplicity n by the n-th root of rounding; a chain of sections
keeps every pole as it is given, and a Q-filter has all its poles in one place.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def shared_realization(
    poles: ComplexArray, numerators: Sequence[Array], scale: float = 1.0, dt: float = 0.0
) -> LinearSystem:
    """Realize ``sum_i numerator_i(s) / prod(s - poles) u_i`` with one state for each pole.

    Parameters
    ----------
    poles
        In conjugate pairs.
    numerators
        One for each input, polynomials in s/scale, highest power first, of degree at most that of
        the denominator, which is monic in s/scale, too.
    scale
        Unit of s, so that coefficients are near 1; a power of two keeps all digits; 1 if sampled.
    dt
        Sample time, s; 0 means continuous time.
    """
    sections = _sections(poles / scale)
    n, inputs = poles.size, len(numerators)
    B, D = np.zeros((n, inputs)), np.zeros((1, inputs))
    whole = np.real(np.atleast_1d(np.poly(poles / scale)))
    for i, numerator in enumerate(numerators):
        share, rest = _divided(numerator, whole)
        D[0, i] = share[-1]
        at = 0
        for section in sections:
            rest, remainder = _divided(rest, section)
            size = section.size - 1
            B[at : at + size, i] = remainder
            at += size
    A = _chain(sections)
    C = np.zeros((1, n))
    if n:
        C[0, n - sections[-1].size + 1] = 1.0
    # A and B have the unit of s.
    return LinearSystem(A * scale, B * scale, C, D, dt)


def _divided(above: Array, below: Array) -> tuple[Array, Array]:
    """Give quotient and remainder of polynomials, below monic; of the remainder all places."""
    size = below.size - 1
    rest = np.concatenate([np.zeros(max(size + 1 - above.size, 0)), above]).astype(float)
    steps = rest.size - size
    for k in range(steps):
        rest[k + 1 : k + below.size] -= rest[k] * below[1:]
    return rest[:steps], rest[steps:]


def _sections(poles: ComplexArray) -> list[Array]:
    """Factors of the denominator, slowest first: s - p, or s^2 + a s + b of a pair."""
    found: list[tuple[float, Array]] = []
    for pole in poles:
        if pole.imag == 0.0:
            found.append((abs(pole), np.array([1.0, -pole.real])))
        elif pole.imag > 0.0:
            found.append((abs(pole), np.array([1.0, -2.0 * pole.real, abs(pole) ** 2])))
    return [each for _, each in sorted(found, key=lambda pair: pair[0])]


def _chain(sections: list[Array]) -> Array:
    n = sum(each.size - 1 for each in sections)
    A, at, before = np.zeros((n, n)), 0, -1
    for section in sections:
        size = section.size - 1
        A[at : at + size, at] = -section[1:]
        if size == 2:
            A[at, at + 1] = 1.0
        if before >= 0:
            A[at + size - 1, before] = 1.0
        before, at = at, at + size
    return A

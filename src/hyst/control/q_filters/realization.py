"""Several transfer functions of one denominator as one system, pole by pole.

A companion form moves a pole of multiplicity n by the n-th root of rounding; a chain of sections
keeps every pole as it is given, and a Q-filter has all its poles in one place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Channel:
    """The numerator of one transfer function, ``gain prod(s - zeros)``.

    Parameters
    ----------
    gain
        Of any sign.
    zeros
        In conjugate pairs, at most as many as there are poles; in the z plane if sampled.
    """

    gain: float
    zeros: ComplexArray


def shared_realization(
    poles: ComplexArray, channels: Sequence[Channel], dt: float = 0.0
) -> LinearSystem:
    """Realize ``sum_i gain_i prod(s - zeros_i) / prod(s - poles) u_i``, one state for each pole.

    Parameters
    ----------
    poles
        In conjugate pairs; in the z plane if sampled.
    channels
        One for each input.
    dt
        Sample time, s; 0 means continuous time.
    """
    # In z the slow roots of fast sampling crowd at 1, and coefficients of their polynomials lose
    # what tells them apart; z - 1 keeps it.
    shift = 1.0 if dt else 0.0
    roots = np.concatenate([poles, *(each.zeros for each in channels)]).astype(np.complex128)
    scale = _unit_of(roots - shift)
    unit = (poles - shift) / scale
    sections = _sections(unit)
    n, inputs = poles.size, len(channels)
    B, D = np.zeros((n, inputs)), np.zeros((1, inputs))
    whole = _polynomial(unit)
    for i, each in enumerate(channels):
        above = _polynomial((each.zeros - shift) / scale)
        above = each.gain * scale ** (each.zeros.size - n) * above
        share, rest = _divided(above, whole)
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
    return LinearSystem(shift * np.eye(n) + scale * A, scale * B, C, D, dt)


def _polynomial(roots: ComplexArray) -> Array:
    return np.real(np.atleast_1d(np.poly(roots)))


def _unit_of(roots: ComplexArray) -> float:
    """Give a power of two in the middle of the roots, which changes no digit."""
    size = np.abs(roots)
    size = size[size > 0.0]
    return float(2.0 ** round(float(np.mean(np.log2(size))))) if size.size else 1.0


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

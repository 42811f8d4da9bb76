"""Plants for the tests of feedback loops, and responses written out by hand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Fraction = tuple[list[float], list[float]]

STAGE_HZ, STAGE_DAMPING, STAGE_DT = 500.0, 0.05, 1e-4
PI: Fraction = ([0.02, 150.0], [1.0, 0.0])


def mode(hertz: float, damping: float, gain: float = 1.0) -> Fraction:
    w = 2.0 * np.pi * hertz
    return [gain * w * w], [1.0, 2.0 * damping * w, w * w]


def product(*fractions: Fraction) -> Fraction:
    above, below = np.array([1.0]), np.array([1.0])
    for num, den in fractions:
        above, below = np.polymul(above, num), np.polymul(below, den)
    return above.tolist(), below.tolist()


def values(fraction: Fraction, s: ComplexArray) -> ComplexArray:
    return np.asarray(np.polyval(fraction[0], s) / np.polyval(fraction[1], s))


def held_mode(hertz: float, damping: float, dt: float, z: ComplexArray) -> ComplexArray:
    """Response of a mode behind a hold: partial fractions of its step response, by hand.

    ``P(s) / s = 1 / s + 2 Re(r / (s - p))`` with ``r = w^2 / (p (p - p*))``, hence
    ``Pd(z) = (z - 1) (1 / (z - 1) + r / (z - e^(p dt)) + conjugate)``.
    """
    w = 2.0 * np.pi * hertz
    p = w * complex(-damping, np.sqrt(1.0 - damping**2))
    r = w * w / (p * (p - p.conjugate()))
    pole = np.exp(p * dt)
    both = r / (z - pole) + r.conjugate() / (z - pole.conjugate())
    # A step held from one sample on gives the values z / (z - 1) ... of the sampled step response.
    return np.asarray((z - 1.0) / z * z * (1.0 / (z - 1.0) + both))


def trapezoidal(fraction: Fraction, z: ComplexArray, dt: float) -> ComplexArray:
    return values(fraction, 2.0 / dt * (z - 1.0) / (z + 1.0))

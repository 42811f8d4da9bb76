"""The two filters of a repetitive controller: what is remembered, and what is learned."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_DECIBELS, _BETA = 40.0, 3.395  # Kaiser 1974: ripple of 0.01, of which sharpening leaves 3 x^2
_SPREAD = (_DECIBELS - 7.95) / (2.0 * 2.285)  # half its length times the angle it falls in
_RIDGE = 1e-6  # of the diagonal: what nothing asks for stays small


@final
@dataclass(frozen=True, eq=False)
class RepetitiveFilters:
    """``w_k = sum_j Q_j s_{k-N+j}``, ``s_k = w_k + sum_j L_j e_{k+j}``.

    Parameters
    ----------
    period
        N, samples.
    smooth
        ``Q_0 .. Q_h``, shape (h + 1,); ``Q_-j = Q_j``.
    learn
        ``L_j``, j = lead - taps + 1 .. lead, shape (taps,).
    lead
        Samples that L looks ahead.
    """

    period: int
    smooth: Array
    learn: Array
    lead: int

    def Q(self, angle: Array) -> Array:
        """Evaluate Q, which is real, at angles w dt, shape (K,)."""
        j = np.arange(1, self.smooth.size)
        return np.asarray(self.smooth[0] + 2.0 * np.cos(np.outer(angle, j)) @ self.smooth[1:])

    def L(self, angle: Array) -> ComplexArray:
        """Evaluate L at angles w dt, shape (K,)."""
        return np.asarray(_powers(angle, self.lead, self.learn.size) @ self.learn)


def low_pass(passed: float, stopped: float) -> Array:
    """Design Q, a zero-phase FIR low-pass whose values are between 0 and 1 at all frequencies.

    ``Q = 3 F^2 - 2 F^3`` of a windowed sinc F with a ripple of about 0.01: it is 1 at rest, within
    0.001 of 1 where it passes, and at most 0.0005 where it stops.

    Parameters
    ----------
    passed, stopped
        Angles w dt up to which it passes, and from which it stops, 0 < passed < stopped <= pi.

    Returns
    -------
    numpy.ndarray
        ``Q_0 .. Q_h``.

    Source
    ------
    Kaiser and Hamming 1977, IEEE Trans. ASSP 25 (5): sharpening.
    """
    middle, width = 0.5 * (passed + stopped), stopped - passed
    half = max(math.ceil(_SPREAD / width), 1)
    j = np.arange(-half, half + 1)
    plain = middle / np.pi * np.sinc(middle / np.pi * j) * np.kaiser(2 * half + 1, _BETA)
    plain /= plain.sum()
    square = np.convolve(plain, plain)
    whole = -2.0 * np.convolve(square, plain)
    whole[half : whole.size - half] += 3.0 * square
    # Symmetric to the last bit, as it will be used.
    right = 0.5 * (whole[whole.size // 2 :] + whole[whole.size // 2 :: -1])
    return np.asarray(right)


def narrowest(half: float) -> float:
    """Give the angle within which ``low_pass`` can fall with so many entries beside ``Q_0``."""
    return _SPREAD / max(math.floor(half / 3.0), 1)


def inverse_taps(
    angle: Array, P: ComplexArray, weight: Array, doubt: Array, lead: int, taps: int
) -> Array:
    """Give the FIR that inverts a plant where it matters, by least squares over frequency.

    The smallest ``sum q^2 (|1 - L P|^2 + doubt^2 |L|^2)``: where the plant is in doubt, less is
    learned.

    Parameters
    ----------
    angle
        Rising, shape (K,), between 0 and pi.
    P
        The plant there.
    weight
        q there.
    doubt
        By how much P may be off, there.
    lead, taps
        As in ``RepetitiveFilters``.
    """
    j = np.arange(lead - taps + 1, lead + 1)
    share = weight**2 * np.gradient(angle)
    # The normal equations are Toeplitz: sums over frequency of cosines of the difference of taps.
    phases = np.exp(1j * np.outer(np.arange(taps), angle))
    column = (phases @ (share * (np.abs(P) ** 2 + doubt**2))).real
    column[0] *= 1.0 + _RIDGE
    right = (np.exp(-1j * np.outer(j, angle)) @ (share * np.conj(P))).real
    return np.asarray(scipy.linalg.solve_toeplitz(column, right))


def _powers(angle: Array, lead: int, taps: int) -> ComplexArray:
    return np.asarray(np.exp(1j * np.outer(angle, np.arange(lead - taps + 1, lead + 1))))

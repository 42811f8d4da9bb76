"""The largest gain a loop of one shape bears, in closed form at each frequency.

With ``L = k L0`` and k growing from 0, a bound on the loop is first met at the least of the gains
at which it is met at a frequency. All of them are quadratic in k; no search over k is needed, and
as no bound is passed on the way, a loop that is stable for small k is stable up to there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def gain_for_sensitivity(loop: ComplexArray, peak: float) -> Array:
    """Give the largest k with ``|1 / (1 + k L0)| <= peak`` from 0 to it.

    ``k^2 |L0|^2 + 2 k Re L0 + 1 - 1 / peak^2 >= 0``

    Parameters
    ----------
    loop
        L0, shape (..., frequencies).
    peak
        Ms, > 1.

    Returns
    -------
    numpy.ndarray
        Shape (...,); infinite where there is no bound.
    """
    return _first_root(np.abs(loop) ** 2, loop.real, 1.0 - 1.0 / peak**2)


def gain_for_complementary(loop: ComplexArray, peak: float) -> Array:
    """Give the largest k with ``|k L0 / (1 + k L0)| <= peak`` from 0 to it; peak > 1.

    Parameters
    ----------
    loop, peak
        L0, shape (..., frequencies), and Mt.

    Returns
    -------
    numpy.ndarray
        Shape (...,).
    """
    return _first_root(np.abs(loop) ** 2 * (1.0 - 1.0 / peak**2), loop.real, 1.0)


def gain_for_uncertainty(loop: ComplexArray, deviation: ComplexArray | Array) -> Array:
    """Give the largest k with ``|k D| < |1 + k L0|`` from 0 to it, D the deviation of L0.

    Parameters
    ----------
    loop, deviation
        L0, shape (..., frequencies), and by how much it may be off.

    Returns
    -------
    numpy.ndarray
        Shape (...,).
    """
    return _first_root(np.abs(loop) ** 2 - np.abs(deviation) ** 2, loop.real, 1.0)


def gain_for_phase(loop: ComplexArray, margin: float) -> Array:
    """Give the largest k at which no crossover is nearer than ``margin`` degrees to -180.

    Parameters
    ----------
    loop, margin
        L0, shape (..., frequencies), and degrees.

    Returns
    -------
    numpy.ndarray
        Shape (...,).
    """
    near = np.abs(np.angle(-loop, deg=True)) < margin
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(near, 1.0 / np.abs(loop), np.inf).min(axis=-1))


def gain_for_gain_margin(loop: ComplexArray, margin: float) -> Array:
    """Give the largest k that may still be multiplied by ``margin`` before the curve meets -1.

    Between neighbouring frequencies of the grid the crossing is placed on a straight line.

    Parameters
    ----------
    loop, margin
        L0, shape (..., frequencies), and the factor.

    Returns
    -------
    numpy.ndarray
        Shape (...,).
    """
    before, after = loop[..., :-1], loop[..., 1:]
    crossed = (before.imag > 0.0) != (after.imag > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = before.imag / (before.imag - after.imag)
        real = before.real + share * (after.real - before.real)
        bound = np.where(crossed & (real < 0.0), -1.0 / (margin * real), np.inf)
    end = loop[..., -1]
    with np.errstate(divide="ignore"):
        last = np.where((end.real < 0) & (np.abs(end.imag) < 1e-9 * np.abs(end)), -end.real, 0.0)
        return np.asarray(np.minimum(bound.min(axis=-1), 1.0 / (margin * last)))


def _first_root(square: Array, half: Array, constant: float) -> Array:
    """Least k > 0 at which ``square k^2 + 2 half k + constant``, positive at 0, is 0."""
    inside = half**2 - square * constant
    with np.errstate(divide="ignore", invalid="ignore"):
        # Written so that square near 0 or below, which has one positive root, needs no case.
        below = -half + np.sqrt(np.maximum(inside, 0.0))
        root = constant / below
    met = (inside >= 0.0) & (below > 0.0)
    return np.asarray(np.where(met, root, np.inf).min(axis=-1))

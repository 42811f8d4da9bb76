"""Peaks over frequency of a curve that a descent lowers.

The stacked gain and the noise gain are such curves, in continuous time and in discrete time; the
descents know of them only what stands here.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Places around a pole where its peak may be, in widths of it.
AROUND = np.array([-3.0, -1.5, -0.7, -0.3, 0.0, 0.3, 0.7, 1.5, 3.0])


class Curve(Protocol):
    """The square of a gain over frequency, for parameters of the poles of Q.

    ``lowest`` and ``highest`` bound the parameters one by one, ``inside`` takes them where all that
    bounds them holds; ``grid`` is ``at`` of a grid of frequencies, with ``w`` in rad/s.
    """

    grid: Any
    lowest: Array
    highest: Array

    def at(self, w: Array) -> Any:
        """Collect what does not depend on the parameters at the frequencies w, rad/s."""

    def inside(self, parameters: Array) -> Array:
        """Give the nearest parameters that are allowed; the same if they are."""

    def values(self, parameters: Array, at: Any) -> Array:
        """Square of the gain for the parameters, at each frequency of at."""

    def values_and_slopes(self, parameters: Array, at: Any) -> tuple[Array, Array]:
        """Square of the gain at each frequency of at, and its derivatives by the parameters."""

    def peaks(self, parameters: Array, share: float = 0.9, rounds: int = 4) -> Array:
        """Frequencies of maxima for the parameters, as ``find_peaks`` gives them: share, rounds."""


def find_peaks(
    curve: Curve, parameters: Array, poles: ComplexArray, share: float, rounds: int
) -> Array:
    """Frequencies of the local maxima that reach a share of the largest, highest first.

    Parameters
    ----------
    curve
        What has peaks.
    parameters
        Of the poles of Q.
    poles
        In 1/s, around which it is looked closely, beside the grid of the curve.
    share
        Of the largest maximum, of gains and not of their squares.
    rounds
        So many times each is closed in on.
    """
    w_grid = curve.grid.w
    sharp = (np.abs(poles.imag)[:, None] + np.abs(poles.real)[:, None] * AROUND).ravel()
    inside = (sharp > w_grid[0]) & (sharp < w_grid[-1])
    more = curve.at(np.unique(np.concatenate([sharp[inside], np.abs(poles)])))
    w = np.concatenate([w_grid, more.w])
    f = np.concatenate([curve.values(parameters, curve.grid), curve.values(parameters, more)])
    w, first = np.unique(w, return_index=True)
    f = f[first]
    above = np.concatenate([[-np.inf], f, [-np.inf]])
    top = (f >= above[:-2]) & (f >= above[2:]) & (f >= share**2 * f.max())
    index = np.flatnonzero(top)
    low, high = w[np.maximum(index - 1, 0)], w[np.minimum(index + 1, w.size - 1)]
    return _refined(curve, parameters, low, w[index], high, rounds)


def _refined(
    curve: Curve, parameters: Array, low: Array, best: Array, high: Array, rounds: int
) -> Array:
    """Close in on each maximum between its neighbours by parabolas, all at once."""
    value = np.full(best.size, -np.inf)
    for _ in range(rounds):
        w = np.concatenate([low, best, high])
        at_low, at_best, at_high = curve.values(parameters, curve.at(w)).reshape(3, -1)
        left, right = low - best, high - best
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = (at_low - at_best) / left, (at_high - at_best) / right
            top = best + 0.5 * (left * b - right * a) / (b - a)
        top = np.where(np.isfinite(top), np.clip(top, low, high), best)
        # The first parabola may miss a sharp peak: the sample before it then stays the best.
        here = curve.values(parameters, curve.at(top))
        better = here >= at_best
        best, value = np.where(better, top, best), np.where(better, here, at_best)
        width = 0.15 * np.minimum(best - low, high - best)
        width = np.maximum(width, 1e-6 * best)
        low, high = best - width, best + width
    return best[np.argsort(-value)]

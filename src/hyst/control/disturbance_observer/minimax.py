"""The last stage of the descent: Newton steps on all high peaks at once.

A minimum of the norm lies where several peaks are equally high. Each peak's height is a smooth
function of the parameters, so the step solves a small quadratic program: least t above the linear
models of all peaks, with the curvature of those that matter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.control.disturbance_observer.peaks import Curve

Array = NDArray[np.float64]

_SHARE = 0.85  # of the norm: lower peaks are left out of a step
_STEP = 1e-4  # for differences of exact slopes


@dataclass(frozen=True)
class Descent:
    """A minimum of the norm: its ``parameters``, the ``norm``, and how many ``evaluations``."""

    parameters: Array
    norm: float
    evaluations: int


def finish(gain: Curve, found: Descent, steps: int = 40, tolerance: float = 1e-7) -> Descent:
    """Take Newton steps from found while the norm falls.

    Parameters
    ----------
    gain
        The gain whose norm is minimized.
    found
        Where to start.
    steps
        At most so many.
    tolerance
        Relative promise of the model below which it ends.
    """
    x, evaluations, damping = found.parameters, found.evaluations, 1e-2
    peaks = gain.peaks(x, _SHARE)
    heights, slopes = gain.values_and_slopes(x, gain.at(peaks))
    weights = np.eye(peaks.size)[0]
    for _ in range(steps):
        unit = heights[0]
        curvature = curvature_of(gain, x, peaks, weights, unit)
        while True:
            step, promise, new_weights = _quadratic_step(
                heights / unit, slopes / unit, curvature + damping * np.eye(x.size)
            )
            if promise < tolerance or damping > 1e9:
                return Descent(x, float(np.sqrt(unit)), evaluations)
            tried = gain.inside(x + step)
            new_peaks = gain.peaks(tried, _SHARE)
            evaluations += 1
            new_heights, new_slopes = gain.values_and_slopes(tried, gain.at(new_peaks))
            gained = (unit - new_heights[0]) / unit
            if gained > 0.1 * promise:
                break
            damping *= 6.0
        if gained > 0.7 * promise:
            damping = max(damping / 6.0, 1e-9)
        weights = carried(peaks, new_weights, new_peaks)
        x, peaks, heights, slopes = tried, new_peaks, new_heights, new_slopes
    return Descent(x, float(np.sqrt(heights[0])), evaluations)


def curvature_of(gain: Curve, x: Array, peaks: Array, weights: Array, unit: float) -> Array:
    """Second derivatives of the weighted heights, each peak moving to stay a maximum.

    Of the curve gain at the parameters x, peaks with their weights, heights over unit.
    """
    held = weights > 1e-6
    w, share, n = peaks[held], weights[held], x.size
    at = gain.at(w)
    second = np.empty((n, n))
    for i in range(n):
        shift = np.zeros(n)
        shift[i] = _STEP
        above = gain.values_and_slopes(x + shift, at)[1]
        below = gain.values_and_slopes(x - shift, at)[1]
        second[i] = share @ (above - below) / (2.0 * _STEP * unit)
    apart = 1e-3
    up, up_slopes = gain.values_and_slopes(x, gain.at(w * np.exp(apart)))
    down, down_slopes = gain.values_and_slopes(x, gain.at(w * np.exp(-apart)))
    middle = gain.values(x, at)
    bend = (up - 2.0 * middle + down) / (apart**2 * unit)
    mixed = (up_slopes - down_slopes) / (2.0 * apart * unit)
    sharp = bend < -1e-6
    second -= (mixed[sharp].T * (share[sharp] / bend[sharp])) @ mixed[sharp]
    values, vectors = np.linalg.eigh(0.5 * (second + second.T))
    # Where the heights curve down the step is left to the damping.
    return np.asarray((vectors * np.maximum(values, 1e-6)) @ vectors.T)


def _quadratic_step(heights: Array, slopes: Array, curvature: Array) -> tuple[Array, float, Array]:
    """Least t + d'Hd/2 with heights + slopes d <= t: the step d, what it promises, weights.

    The weights, nonnegative and of sum 1, solve the dual: least |R m|^2 / 2 - heights m.
    """
    within = np.linalg.solve(np.linalg.cholesky(curvature), slopes.T)
    below = heights - heights.max()
    # With the sum at 1, (s - below m / s)^2 is s^2 - 2 below m, but for a term in 1/s^2: the dual
    # is a least-squares problem with nonnegative unknowns.
    s = 1e3
    system = np.vstack([within, s - below / s, np.full(below.size, 1e3 * s)])
    target = np.zeros(system.shape[0])
    target[-1] = 1e3 * s
    m, _ = scipy.optimize.nnls(system, target)
    m /= m.sum()
    step = -np.linalg.solve(curvature, slopes.T @ m)
    level = float((heights + slopes @ step).max()) + 0.5 * float(step @ curvature @ step)
    return step, float(heights.max()) - level, m


def carried(peaks: Array, weights: Array, new_peaks: Array) -> Array:
    """Give the weights of the peaks to the nearest of the new_peaks."""
    given = np.zeros(new_peaks.size)
    for w, share in zip(peaks, weights, strict=True):
        given[np.argmin(np.abs(np.log(new_peaks / w)))] += share
    return given

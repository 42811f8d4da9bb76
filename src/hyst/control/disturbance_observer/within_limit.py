"""The least peak of one curve while another stays within a limit.

Both are maxima over frequency. Each step takes the logarithms of all high peaks of both as linear
in the parameters, with the curvature of those that matter, and solves a small quadratic program:
least t above the peaks of the first, those of the second below the limit. A step is taken if it
lowers the first peak plus a penalty on what the second is above its limit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.control.disturbance_observer.minimax import Descent, carried, curvature_of
from hyst.control.disturbance_observer.peaks import Curve

Array = NDArray[np.float64]

_SHARE = 0.8  # of the highest peak: lower ones are left out of a step
_SOFT = 1e-9  # of the limit's multiplier: what is out of reach is missed by little
_PENALTY = 10.0
_SPARE = 1e-5  # of the limit, that an end just above it is not lost
_LONGEST = 2.0  # step, in logarithms


@dataclass(frozen=True)
class _Heights:
    """Logarithms of the high peaks of a curve, the highest first, with slopes and frequencies."""

    w: Array
    heights: Array
    slopes: Array


def least_within(
    curve: Curve,
    limited: Curve,
    limit: float,
    start: Array,
    steps: int = 40,
    tolerance: float = 1e-4,
) -> Descent:
    """Lower the highest peak of a curve while that of another is at most at its limit.

    Parameters
    ----------
    curve
        The square of what is minimized.
    limited
        The square of what has a limit, for the same parameters.
    limit
        Of the gain, not of its square.
    start
        Parameters, which need not keep the limit.
    steps
        At most so many.
    tolerance
        Promise of a step, relative, below which it ends.

    Returns
    -------
    Descent
        Its ``norm`` is that of the curve, or inf where the limit is not kept.
    """
    top = 2.0 * np.log((1.0 - _SPARE) * limit)
    x, evaluations, damping, penalty = curve.inside(start), 1, 1e-2, _PENALTY
    here, other = _heights(curve, x), _heights(limited, x)
    shares = np.eye(here.w.size)[0], np.zeros(other.w.size)
    for _ in range(steps):
        curvature = _curvature(curve, x, here, shares[0]) + _curvature(limited, x, other, shares[1])
        while True:
            step, weights = _step(here, other, top, _damped(curvature, damping))
            penalty = max(penalty, 2.0 * float(weights[1].sum()))
            merit = _merit(here.heights, other.heights, top, penalty)
            expected = _merit(
                here.heights + here.slopes @ step,
                other.heights + other.slopes @ step,
                top,
                penalty,
            )
            promise = merit - expected
            if promise < tolerance or damping > 1e9:
                return _ended(x, here, other, top, evaluations)
            tried = curve.inside(x + step)
            now, then = _heights(curve, tried), _heights(limited, tried)
            evaluations += 1
            gained = merit - _merit(now.heights, then.heights, top, penalty)
            if gained > 0.1 * promise:
                break
            damping *= 6.0
        if gained > 0.7 * promise:
            damping = max(damping / 6.0, 1e-9)
        shares = carried(here.w, weights[0], now.w), carried(other.w, weights[1], then.w)
        x, here, other = tried, now, then
    return _ended(x, here, other, top, evaluations)


def _ended(x: Array, here: _Heights, other: _Heights, top: float, evaluations: int) -> Descent:
    kept = other.heights[0] <= top - 2.0 * np.log(1.0 - _SPARE)
    return Descent(x, float(np.exp(0.5 * here.heights[0])) if kept else np.inf, evaluations)


def _heights(curve: Curve, x: Array) -> _Heights:
    w = curve.peaks(x, _SHARE, rounds=3)
    with np.errstate(all="ignore"):
        values, slopes = curve.values_and_slopes(x, curve.at(w))
        heights, slopes = np.log(values), slopes / values[:, None]
    if not (np.isfinite(heights).all() and np.isfinite(slopes).all()):
        heights, slopes = np.full(w.size, np.inf), np.zeros(slopes.shape)
    return _Heights(w, heights, slopes)


def _merit(heights: Array, limited: Array, top: float, penalty: float) -> float:
    return float(heights.max() + penalty * max(0.0, limited.max() - top))


def _curvature(curve: Curve, x: Array, at: _Heights, shares: Array) -> Array:
    if not (shares > 1e-6).any():
        return np.zeros((x.size, x.size))
    return curvature_of(curve, x, at.w, shares / np.exp(at.heights), 1.0)


def _damped(curvature: Array, damping: float) -> Array:
    # Where curvatures differ by more than doubles hold, the least of them is rounding.
    return curvature + (damping + 1e-12 * float(np.trace(curvature))) * np.eye(len(curvature))


def _step(
    here: _Heights, other: _Heights, top: float, curvature: Array
) -> tuple[Array, tuple[Array, Array]]:
    """Least t + d'Hd/2 with heights + slopes d <= t and those of the other curve at most top.

    The weights of the peaks solve the dual as in ``minimax``: those of the first curve have the
    sum 1, those of the other are free, but softly, so that there is always a solution.
    """
    first = here.w.size
    slopes = np.vstack([here.slopes, other.slopes])
    level = np.concatenate([here.heights - here.heights.max(), other.heights - top])
    within = np.linalg.solve(np.linalg.cholesky(curvature), slopes.T)
    sums = np.concatenate([np.ones(first), np.zeros(other.w.size)])
    soft = np.sqrt(_SOFT) * np.eye(slopes.shape[0])[first:]
    s = 1e3
    system = np.vstack([within, soft, s * sums - level / s, 1e3 * s * sums])
    target = np.zeros(system.shape[0])
    target[-1] = 1e3 * s
    m, _ = scipy.optimize.nnls(system, target)
    m[:first] /= m[:first].sum()
    step = -np.linalg.solve(curvature, slopes.T @ m)
    longest = float(np.abs(step).max())
    return step * min(1.0, _LONGEST / max(longest, 1e-300)), (m[:first], m[first:])

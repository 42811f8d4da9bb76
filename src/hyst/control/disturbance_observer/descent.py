"""Descent on the exact H-infinity norm of the stacked gain, from several starts.

The norm is a maximum over frequencies: smooth almost everywhere, with a kink where two peaks are
equally high, which is where minima lie. BFGS with a line search for the weak Wolfe conditions walks
through kinks (Lewis and Overton, Nonsmooth optimization via quasi-Newton methods, 2013). Its end is
then finished by exchange: the least t above the gain at all peaks met so far is a smooth problem.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.control.disturbance_observer.stacked_gain import StackedGain

Array = NDArray[np.float64]

_FAR = 25.0  # logarithms beyond this are poles 10 decades away: no use, and a danger to accuracy
_SETTLED = 1e-7


@dataclass(frozen=True)
class Descent:
    """A minimum of the norm: its ``parameters``, the ``norm``, and how many ``evaluations``."""

    parameters: Array
    norm: float
    evaluations: int


def norm_and_slope(gain: StackedGain, parameters: Array) -> tuple[float, Array]:
    """Give the norm and its gradient, that of the gain at the highest peak, at the parameters."""
    highest = gain.peaks(parameters, 1.0)[:1]
    value, slope = gain.values_and_slopes(parameters, gain.at(highest))
    norm = float(np.sqrt(value[0]))
    return norm, slope[0] / (2.0 * norm)


def descend(gain: StackedGain, start: Array, steps: int = 100) -> Descent:
    """Go down from start, first by BFGS and then by exchange of peaks.

    Parameters
    ----------
    gain
        The gain whose norm is minimized.
    start
        Parameters of stable poles.
    steps
        At most so many of BFGS.
    """
    coarse = _bfgs(gain, start, steps)
    return _exchange(gain, coarse)


def descend_from_many(
    gain: StackedGain,
    given: list[Array],
    random_starts: int = 8,
    seed: int = 0,
    progress: Callable[[int, float], None] | None = None,
) -> Descent:
    """Give the best of descents from given and from random parameters.

    Parameters
    ----------
    gain
        The gain whose norm is minimized.
    given
        Parameters tried first.
    random_starts
        Number of further ones.
    seed
        Of the random starts: the same seed gives the same result.
    progress
        Called with the number of descents done and the best norm.
    """
    starts = given + random_parameters(gain, random_starts, seed)
    best: Descent | None = None
    for i, start in enumerate(starts):
        found = descend(gain, start)
        if best is None or found.norm < best.norm:
            best = found
        if progress is not None:
            progress(i + 1, best.norm)
    assert best is not None
    return best


def random_parameters(gain: StackedGain, count: int, seed: int) -> list[Array]:
    """Draw parameters of stable poles: count sets, by seed, over the band where gain has features.

    The best of a few is kept each time, so that descents start from where they can be short.
    """
    rng = np.random.default_rng(seed)
    size = np.log(np.abs(gain.features) / gain.scale)
    low, high = size.min() - 1.0, size.max() + 1.0
    starts = []
    for _ in range(count):
        drawn = []
        for _ in range(6):
            frequency = rng.uniform(low, high, gain.order)
            pairs = gain.order // 2
            values = np.empty(gain.order)
            values[1 : 2 * pairs : 2] = 2.0 * frequency[:pairs]
            values[0 : 2 * pairs : 2] = frequency[:pairs] + rng.uniform(-0.5, 2.5, pairs)
            values[2 * pairs :] = frequency[2 * pairs :]
            drawn.append((float(gain.values(values, gain.grid).max()), values))
        starts.append(min(drawn, key=lambda each: each[0])[1])
    return starts


def _bfgs(gain: StackedGain, start: Array, steps: int) -> Descent:
    x = np.clip(start, -_FAR, _FAR)
    f, slope = norm_and_slope(gain, x)
    inverse, evaluations = np.eye(x.size), 1
    for _ in range(steps):
        direction = -inverse @ slope
        if not slope @ direction < 0.0:
            inverse, direction = np.eye(x.size), -slope
        direction *= min(1.0, 3.0 / float(np.abs(direction).max(initial=1e-12)))
        step, f_new, new_slope, tried = _weak_wolfe(gain, x, f, slope, direction)
        evaluations += tried
        if step == 0.0 or f - f_new < _SETTLED * f:
            if f_new < f:
                x, f = x + step * direction, f_new
            break
        s, y = step * direction, new_slope - slope
        x, f, slope = x + s, f_new, new_slope
        curvature = float(s @ y)
        if curvature > 0.0:
            along = np.eye(x.size) - np.outer(s, y) / curvature
            inverse = along @ inverse @ along.T + np.outer(s, s) / curvature
    return Descent(x, f, evaluations)


def _weak_wolfe(
    gain: StackedGain, x: Array, f: float, slope: Array, direction: Array
) -> tuple[float, float, Array, int]:
    """Bisect for a step that descends enough and leaves the slope less steep."""
    low, high, step = 0.0, np.inf, 1.0
    along = float(slope @ direction)
    best = (0.0, f, slope)
    for tried in range(1, 21):
        point = x + step * direction
        f_new, new_slope = (np.inf, slope)
        if np.abs(point).max() <= _FAR:
            f_new, new_slope = norm_and_slope(gain, point)
        if not f_new <= f + 1e-4 * step * along:
            high = step
        else:
            best = (step, f_new, new_slope)
            if new_slope @ direction >= 0.9 * along:
                return *best, tried
            low = step
        step = 0.5 * (low + high) if np.isfinite(high) else 2.0 * step
    return *best, tried


def _exchange(gain: StackedGain, found: Descent, rounds: int = 12) -> Descent:
    """Minimize the largest of the gains at the peaks, add the peaks that result, and repeat."""
    x, norm, evaluations = found.parameters, found.norm, found.evaluations
    known, trust = gain.peaks(x, 0.8), 1.0
    for _ in range(rounds):
        at = gain.at(np.unique(np.concatenate([known, gain.grid.w[::4]])))
        tried, count = _least_maximum(gain, x, norm, at, trust)
        evaluations += count
        peaks = gain.peaks(tried, 0.8)
        reached = float(np.sqrt(gain.values(tried, gain.at(peaks[:1]))[0]))
        known = np.unique(np.concatenate([known, peaks]))
        gained = norm - reached
        if gained > 0.0:
            x, norm = tried, reached
            trust = min(2.0 * trust, 3.0)
        else:
            trust *= 0.3
        if abs(gained) < _SETTLED * norm or trust < 1e-3:
            break
    return Descent(x, norm, evaluations)


def _least_maximum(
    gain: StackedGain, x: Array, norm: float, at: object, trust: float
) -> tuple[Array, int]:
    """Least t with gain(w; x)^2 <= t at given frequencies, within trust of x."""
    size, unit = x.size, norm**2

    def room(z: Array) -> Array:
        return np.asarray(z[-1] - gain.values(z[:size], at) / unit)

    def slope_of_room(z: Array) -> Array:
        slopes = gain.values_and_slopes(z[:size], at)[1]
        return np.hstack([-slopes / unit, np.ones((slopes.shape[0], 1))])

    towards = np.concatenate([np.zeros(size), [1.0]])
    low, high = np.maximum(x - trust, -_FAR), np.minimum(x + trust, _FAR)
    result = scipy.optimize.minimize(
        lambda z: z[-1],
        np.concatenate([x, [1.0]]),
        jac=lambda z: towards,
        method="SLSQP",
        bounds=[*zip(low, high, strict=True), (0.0, 2.0)],
        constraints={"type": "ineq", "fun": room, "jac": slope_of_room},
        options={"maxiter": 40, "ftol": 1e-10},
    )
    return np.clip(result.x[:size], low, high), int(result.nfev)

"""Descent on the exact H-infinity norm of the stacked gain, from several starts.

The norm is a maximum over frequencies: smooth almost everywhere, with a kink where two peaks are
equally high, which is where minima lie. BFGS with a line search for the weak Wolfe conditions walks
through kinks (Lewis and Overton, Nonsmooth optimization via quasi-Newton methods, 2013). Its end is
then finished by exchange: the least t above the gain at all peaks met so far is a smooth problem.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.minimax import Descent, finish
from hyst.control.disturbance_observer.smoothing import descend_smoothed
from hyst.control.disturbance_observer.stacked_gain import StackedGain

Array = NDArray[np.float64]

_SETTLED = 1e-4
_LONG = 100
_KEPT, _AGAIN = 3, 3
_RANDOM = 8  # starts at least
_HOPS, _HOP = 8, 0.7  # from the best so far, and how far in logarithms


def norm_and_slope(gain: StackedGain, parameters: Array) -> tuple[float, Array]:
    """Give the norm and its gradient, that of the gain at the highest peak, at the parameters."""
    highest = gain.peaks(parameters, rounds=2)[:1]
    with np.errstate(all="ignore"):
        value, slope = gain.values_and_slopes(parameters, gain.at(highest))
        norm = float(np.sqrt(value[0]))
        slope = slope[0] / (2.0 * norm)
    if not (np.isfinite(norm) and np.isfinite(slope).all()):
        return np.inf, np.zeros(parameters.size)
    return norm, slope


def descend(gain: StackedGain, start: Array) -> Descent:
    """Go down with gain from the parameters start as far as it goes: BFGS, Newton, again."""
    found = finish(gain, _bfgs(gain, start, _LONG))
    for _ in range(_AGAIN):
        before = found.norm
        found = finish(gain, _bfgs(gain, found.parameters, _LONG))
        if found.norm > (1.0 - _SETTLED) * before:
            break
    return found


def descend_from_many(
    gain: StackedGain,
    given: list[Array],
    random_starts: int | None = None,
    seed: int = 0,
    progress: Callable[[int, float], None] | None = None,
) -> Descent:
    """Give the best of descents from given, from usual and from random parameters.

    Descents on a smoothed norm from all, on the exact one from the best of them; then hops from
    the best to its neighbourhood, for minima are many.

    Parameters
    ----------
    gain
        The gain whose norm is minimized.
    given
        Parameters tried first.
    random_starts
        Number of random ones; more for higher orders if left out.
    seed
        Of the random starts: the same seed gives the same result.
    progress
        Called with the number of descents done and the best norm.
    """
    usual = usual_parameters(gain)
    if random_starts is None:
        random_starts = max(_RANDOM, 2 * gain.order)
    found: list[Descent] = []

    def note(each: Descent) -> Descent:
        found.append(each)
        if progress is not None:
            progress(len(found), min(other.norm for other in found))
        return each

    smooth = []
    for start in given + usual + random_parameters(gain, random_starts, seed):
        x = descend_smoothed(gain, start)
        smooth.append(note(Descent(x, norm_and_slope(gain, x)[0], 1)))
    for each in sorted(smooth, key=lambda descent: descent.norm)[:_KEPT]:
        note(finish(gain, each))
    for start in given + usual:
        note(finish(gain, Descent(start, norm_and_slope(gain, start)[0], 1)))
    rng = np.random.default_rng(seed)
    for _ in range(_HOPS):
        best = min(found, key=lambda descent: descent.norm)
        x = gain.inside(best.parameters + rng.normal(0.0, _HOP, best.parameters.size))
        note(finish(gain, Descent(x, norm_and_slope(gain, x)[0], 1)))
    note(descend(gain, min(found, key=lambda descent: descent.norm).parameters))
    best = min(found, key=lambda descent: descent.norm)
    return replace(best, evaluations=sum(each.evaluations for each in found))


def usual_parameters(gain: StackedGain, kept: int = 2) -> list[Array]:
    """Give poles of Q that an engineer would try: of each kind those best on the grid of gain.

    Butterworth poles of several bandwidths; with some of the poles on the zeros of the plant, which
    makes Q a plain low pass, on its poles, or on those of the loop with the controller. Each
    eigenvalue of the internal model but one at 0 keeps a pole of its own close by: then it costs
    little, for what it adds to 1 - Q nearly cancels. So many of each kind are kept.
    """
    size = np.abs(gain.features)
    others = _without_one_at_zero(gain.model_poles)
    kinds = [np.zeros(0, complex), gain.plant.zeros, gain.plant.poles, gain.S0.poles]
    starts = []
    for kind in kinds:
        taken = _slowest(kind, gain.order - others.size - 1)
        count = gain.order - others.size - taken.size
        circle = -np.exp(1j * np.pi * (np.arange(count) - 0.5 * (count - 1)) / (2.0 * count))
        drawn = []
        for bandwidth in np.geomspace(0.3 * size.min(), 3.0 * size.max(), 24):
            for shift in (0.01, 0.2):
                close = others - shift * np.where(np.abs(others) > 0.0, np.abs(others), bandwidth)
                poles = np.concatenate([bandwidth * circle, close, taken])
                poles = np.where(np.abs(poles.imag) < 1e-9 * np.abs(poles), poles.real, poles)
                values = gain.inside(gain.parameters_of(poles))
                drawn.append((float(gain.values(values, gain.grid).max()), values))
        if kind.size or kind is kinds[0]:
            starts += sorted(drawn, key=lambda each: each[0])[:kept]
    ordered = [values for _, values in sorted(starts, key=lambda each: each[0])]
    # Without an eigenvalue to keep close to, both shifts are one start.
    return [
        each
        for i, each in enumerate(ordered)
        if not any(np.array_equal(each, other) for other in ordered[:i])
    ]


def _slowest(poles: Array, count: int) -> Array:
    """At most count of the poles, pairs kept together."""
    ordered = poles[np.argsort(np.abs(poles), kind="stable")][:count]
    whole = [p for p in ordered if p.imag == 0.0 or np.isclose(ordered, np.conj(p)).any()]
    return np.array(whole, dtype=complex)


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


def _without_one_at_zero(poles: Array) -> Array:
    return np.delete(poles, np.argmin(np.abs(poles)))


def _bfgs(gain: StackedGain, start: Array, steps: int) -> Descent:
    x = gain.inside(start)
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
        if np.array_equal(point, gain.inside(point)):
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

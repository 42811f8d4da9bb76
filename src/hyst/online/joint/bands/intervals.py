"""How far a parameter can go before the data object: profiles of the chi-square."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.online.joint.bands.refit import Minimum, Problem, minimum_from

Array = NDArray[np.float64]

RISE = 4.0
"""Rise of the chi-square at two standard errors."""

_AS_QUADRATIC = (2.5, 6.5)
_STEPS = 12
_REFINED = 5


def covariance_of_minimum(problem: Problem, minimum: Minimum, spreads: float = 5.0) -> Array:
    """Give the covariance, with the spreads of the start where the data say nothing.

    Parameters
    ----------
    problem, minimum
        What was fitted, and where.
    spreads
        How many times that of the start a spread may be.

    Returns
    -------
    numpy.ndarray
        Shape (m, m), zero where held.
    """
    free = problem.free
    scale = np.sqrt(problem.limit[free])
    own = minimum.information[np.ix_(free, free)] * np.outer(scale, scale)
    found = np.zeros_like(minimum.information)
    # In units of the spreads of the start, which are far wider than what data determine.
    inverse = np.linalg.inv(own + np.eye(own.shape[0]) / spreads**2)
    found[np.ix_(free, free)] = inverse * np.outer(scale, scale)
    return found


def interval_of(
    problem: Problem, minimum: Minimum, covariance: Array, place: int, best: float
) -> tuple[float, float, bool]:
    """Give the interval of one parameter in which the chi-square rises by at most 4.

    Parameters
    ----------
    problem, minimum
        What was fitted, and where.
    covariance
        There.
    place
        Of the parameter, which is not held.
    best
        Least chi-square of all minima.

    Returns
    -------
    low, high : float
    is_quadratic : bool
        Whether it is that of two standard errors.
    """
    deviation = float(np.sqrt(covariance[place, place]))
    value = float(minimum.theta[place])
    along = covariance[:, place] / deviation
    ends, quadratic = [], True
    room = RISE + best - minimum.chi_square
    for side in (-1.0, 1.0):
        rise = np.inf
        if room >= RISE - 1e-6:
            there = minimum.theta + side * 2.0 * along
            if np.array_equal(problem.admissible(there), there):
                error, _ = problem.residual(there)
                rise = float(error @ error) - minimum.chi_square
        if _AS_QUADRATIC[0] <= rise <= _AS_QUADRATIC[1]:
            ends.append(value + side * 2.0 * deviation)
        else:
            quadratic = False
            ends.append(_profile(problem, minimum, place, side, deviation, along, best + RISE))
    return ends[0], ends[1], quadratic


def _profile(
    problem: Problem,
    minimum: Minimum,
    place: int,
    side: float,
    deviation: float,
    along: Array,
    most: float,
) -> float:
    """Step outwards until least squares with the parameter held exceed ``most``."""
    value = float(minimum.theta[place])
    inside, step = 0.0, min(deviation, 0.25 * _size(problem, minimum, place))
    theta, square_inside = minimum.theta, minimum.chi_square
    outside, square_outside = np.inf, np.inf
    for _ in range(_STEPS):
        if np.isfinite(outside):
            break
        ahead = inside + step
        found = _held(
            problem, theta, place, float(minimum.theta[place]) + side * ahead, most, along
        )
        if found is None:
            return _limit_of(problem, minimum, place, side)
        if found.chi_square <= most:
            inside, theta, square_inside = ahead, found.theta, found.chi_square
            step *= 2.0
        else:
            outside, square_outside = ahead, found.chi_square
    if not np.isfinite(outside):
        return _limit_of(problem, minimum, place, side)
    for _ in range(_REFINED):
        if outside - inside < 0.1 * deviation:
            break
        # The square root of the rise is nearly linear.
        low = np.sqrt(max(square_inside - minimum.chi_square, 0.0))
        high = np.sqrt(square_outside - minimum.chi_square)
        wanted = np.sqrt(max(most - minimum.chi_square, 0.0))
        share = np.clip((wanted - low) / max(high - low, 1e-300), 0.2, 0.8)
        ahead = inside + float(share) * (outside - inside)
        found = _held(
            problem, theta, place, float(minimum.theta[place]) + side * ahead, most, along
        )
        if found is not None and found.chi_square <= most:
            inside, theta, square_inside = ahead, found.theta, found.chi_square
        else:
            outside = ahead
            square_outside = np.inf if found is None else found.chi_square
            if found is None:
                break
    return value + side * outside


def _held(
    problem: Problem, theta: Array, place: int, value: float, most: float, along: Array
) -> Minimum | None:
    n = problem.parts.pi.p.size
    least, most, most_radius = problem.bounds
    if n < place <= 2 * n and not 0.0 <= value <= min(most_radius, 0.5 * problem.samples.swing):
        return None
    if place == 0 and not least <= value <= most:
        return None
    # Along the valley as it is at the minimum, or the others stay where they are.
    valley = theta + (value - theta[place]) / along[place] * along
    valley[place] = value
    found = minimum_from(problem, valley, place, most - 1.0)
    if found.chi_square <= most:
        return found
    alone = theta.copy()
    alone[place] = value
    other = minimum_from(problem, alone, place, most - 1.0)
    return other if other.chi_square < found.chi_square else found


def _size(problem: Problem, minimum: Minimum, place: int) -> float:
    n = problem.parts.pi.p.size
    if n < place <= 2 * n:
        return 0.5 * problem.samples.swing / n
    return float(np.sqrt(problem.limit[place])) if place > 2 * n else _weights_size(minimum, n)


def _weights_size(minimum: Minimum, n: int) -> float:
    return float(np.abs(minimum.theta[: n + 1]).sum()) / (n + 1)


def _limit_of(problem: Problem, minimum: Minimum, place: int, side: float) -> float:
    n = problem.parts.pi.p.size
    if n < place <= 2 * n and side < 0.0:
        return 0.0
    if place == 0 and side < 0.0:
        return problem.bounds[0]
    return side * np.inf

"""Where least squares may start: radii on a grid, exchanged one by one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.online.joint.bands.prediction import plays_after
from hyst.online.joint.bands.refit import Problem

Array = NDArray[np.float64]

_GRID = 64
_SWEEPS = 6
_RELOCATED = 8
# Of the chi-square, before weights and radii have followed.
_MOST_LOSS = 400.0


@dataclass(frozen=True, eq=False)
class Grid:
    """Normal equations of plays on a grid of radii, in units of the noise.

    Parameters
    ----------
    radius
        Shape (K,).
    columns
        Shape (K + 2, R): the input, 1, and the plays.
    target
        Shape (R,), outputs.
    """

    radius: Array
    columns: Array
    target: Array


def grid_of(problem: Problem) -> Grid | None:
    """Give the grid for a problem, None where something of the plays is held or there is a map."""
    parts, samples = problem.parts, problem.samples
    n = parts.pi.p.size
    has_maps = parts.front is not None or parts.back is not None
    if has_maps or n == 0 or not problem.free[: 2 * n + 1].all():
        return None
    radius = 0.5 * samples.swing * (np.arange(_GRID) + 0.5) / _GRID
    weight = np.sqrt(samples.count / problem.noise)
    columns = np.vstack([samples.way[-1], np.ones(samples.y.size), _plays(problem, radius)])
    return Grid(radius, columns * weight, weight * samples.y)


def starts_on_grid(problem: Problem, grid: Grid, theta: Array) -> list[Array]:
    """Give parameters whose radii are the best on a grid that exchanges of one radius find.

    The output is linear in the weights of plays of given radii, so each set of radii has its one
    least square. From three sets each radius in turn goes to the place where it leaves least.

    Parameters
    ----------
    problem, grid
        What is fitted.
    theta
        Shape (m,), the estimate.

    Returns
    -------
    list of numpy.ndarray
        Shape (m,) each.
    """
    n = problem.parts.pi.p.size
    gram, target = grid.columns @ grid.columns.T, grid.columns @ grid.target
    own = np.clip(np.searchsorted(grid.radius, theta[n + 1 : 2 * n + 1]), 0, _GRID - 1)
    last = max(float(theta[2 * n]), float(grid.radius[0]))
    even = last * (np.arange(n) + 1.0) / n
    spread = np.clip(np.searchsorted(grid.radius, even), 0, _GRID - 1)
    found: list[Array] = []
    for first in (own, spread, _greedy(gram, target, n)):
        places = _exchanged(gram, target, _apart(first))
        base = np.concatenate([[0, 1], places + 2])
        weights = _solved(gram[np.ix_(base, base)], target[base])
        start = _with(theta, n, weights, grid.radius[places])
        if not any(np.array_equal(start, each) for each in found):
            found.append(start)
    return found


def relocations(problem: Problem, grid: Grid, theta: Array) -> list[Array]:
    """Give parameters that differ from a minimum by one play, which is elsewhere nearly as good.

    Parameters
    ----------
    problem, grid
        What is fitted.
    theta
        Shape (m,), the minimum.

    Returns
    -------
    list of numpy.ndarray
        Shape (m,) each, those first that lose least.
    """
    n = problem.parts.pi.p.size
    r = theta[n + 1 : 2 * n + 1]
    samples = problem.samples
    own = _plays(problem, r) * np.sqrt(samples.count / problem.noise)
    columns = np.vstack([grid.columns, own])
    gram, target = columns @ columns.T, columns @ grid.target
    found: list[tuple[float, Array]] = []
    for i in range(n):
        others = np.delete(np.arange(n), i) + _GRID
        gains = _gains(gram, target, others)
        at_home = max(float(gains[_GRID + i]), 0.0)
        inner = gains[:_GRID]
        padded = np.concatenate([[-1.0], inner, [-1.0]])
        peaks = np.flatnonzero((inner >= padded[:-2]) & (inner >= padded[2:]) & (inner > 0.0))
        for place in peaks:
            if abs(grid.radius[place] - r[i]) > grid.radius[0] * 2.0:
                base = np.concatenate([[0, 1], others + 2, [place + 2]])
                weights = _solved(gram[np.ix_(base, base)], target[base])
                radii = np.append(np.delete(r, i), grid.radius[place])
                order = np.argsort(radii)
                weights[2:] = weights[2:][order]
                found.append(
                    (at_home - float(inner[place]), _with(theta, n, weights, radii[order]))
                )
    found.sort(key=lambda each: each[0])
    return [start for loss, start in found[:_RELOCATED] if loss < _MOST_LOSS]


def scattered(problem: Problem, grid: Grid, theta: Array, count: int) -> list[Array]:
    """Give parameters of random sets of radii, with the weights that fit best.

    Parameters
    ----------
    problem, grid
        What is fitted.
    theta
        Shape (m,), the estimate.
    count
        How many.

    Returns
    -------
    list of numpy.ndarray
        Shape (m,) each.
    """
    n = problem.parts.pi.p.size
    rng = np.random.default_rng(0)
    last = max(float(theta[2 * n]), float(grid.radius[0]))
    root = np.sqrt(problem.samples.count / problem.noise)
    found = []
    for _ in range(count):
        radii = np.sort(rng.uniform(0.0, min(1.3 * last, float(grid.radius[-1])), n))
        columns = np.vstack([grid.columns[:2], _plays(problem, radii) * root])
        weights = _solved(columns @ columns.T, columns @ grid.target)
        found.append(_with(theta, n, weights, radii))
    return found


def _plays(problem: Problem, radius: Array) -> Array:
    pi = problem.parts.pi
    return plays_after(problem.samples.way, radius, np.interp(radius, pi.r, pi.z0)).z


def _with(theta: Array, n: int, weights: Array, radii: Array) -> Array:
    start = theta.copy()
    start[0], start[2 * n + 1] = weights[0], weights[1]
    start[1 : n + 1], start[n + 1 : 2 * n + 1] = weights[2:], radii
    return start


def _regular(gram: Array) -> Array:
    own = np.diag(gram)
    return np.asarray(gram + np.diag(1e-10 * own + 1e-12 * own.max() + 1e-300))


def _solved(gram: Array, target: Array) -> Array:
    return np.asarray(np.linalg.solve(_regular(gram), target))


def _apart(places: NDArray[np.intp]) -> NDArray[np.intp]:
    """Move places that coincide to the next free ones."""
    taken: list[int] = []
    for each in places.tolist():
        free = np.setdiff1d(np.arange(_GRID), taken)
        taken.append(int(free[np.argmin(np.abs(free - each))]))
    return np.sort(np.array(taken))


def _gains(gram: Array, target: Array, kept: NDArray[np.intp]) -> Array:
    """Give what the squares lose by one more column beside those kept, for each on the grid."""
    base = np.concatenate([[0, 1], kept + 2])
    inner = gram[np.ix_(base, base)]
    cross = gram[base]
    solved = np.linalg.solve(_regular(inner), np.column_stack([cross, target[base]]))
    left = np.diag(gram) - (cross * solved[:, :-1]).sum(axis=0)
    slope = target - cross.T @ solved[:, -1]
    usable = left > 1e-8 * np.diag(gram)
    # A weight below 0 is none that plays of an actuator have.
    gains = np.where(usable & (slope > 0.0), slope**2 / np.where(usable, left, 1.0), 0.0)
    gains[base] = 0.0
    return np.asarray(gains[2:])


def _greedy(gram: Array, target: Array, n: int) -> NDArray[np.intp]:
    kept = np.zeros(0, dtype=np.intp)
    for _ in range(n):
        kept = np.append(kept, int(np.argmax(_gains(gram, target, kept))))
    return np.sort(kept)


def _exchanged(gram: Array, target: Array, places: NDArray[np.intp]) -> NDArray[np.intp]:
    kept = places.copy()
    for _ in range(_SWEEPS):
        before = np.sort(kept)
        for k in range(kept.size):
            others = np.delete(kept, k)
            gains = _gains(gram, target, others)
            best = int(np.argmax(gains))
            if gains[best] > gains[kept[k]] * (1.0 + 1e-9) and best not in others:
                kept[k] = best
        if np.array_equal(np.sort(kept), before):
            break
    return np.sort(kept)

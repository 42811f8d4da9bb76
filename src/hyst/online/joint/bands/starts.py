"""Where least squares may start: radii on a grid, exchanged one by one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.online.joint.bands.prediction import plays_after
from hyst.online.joint.bands.refit import Problem

Array = NDArray[np.float64]

_GRID = 64
_SWEEPS = 6


def starts_on_grid(problem: Problem, theta: Array) -> list[Array]:
    """Give parameters whose radii are the best on a grid that exchanges of one radius find.

    The output is linear in the weights of plays of given radii, so each set of radii has its one
    least square. From three sets each radius in turn goes to the place where it leaves least.

    Parameters
    ----------
    problem
        Without maps.
    theta
        Shape (m,), the estimate.

    Returns
    -------
    list of numpy.ndarray
        Shape (m,) each; empty where something of the plays is held or there is a map.
    """
    n = problem.parts.pi.p.size
    has_maps = problem.parts.front is not None or problem.parts.back is not None
    if has_maps or n == 0 or not problem.free[: 2 * n + 1].all():
        return []
    samples = problem.samples
    half = 0.5 * samples.swing
    grid = half * (np.arange(_GRID) + 0.5) / _GRID
    z0 = np.interp(grid, problem.parts.pi.r, problem.parts.pi.z0)
    z = plays_after(samples.way, grid, z0).z
    columns = np.vstack([samples.way[-1], np.ones(samples.y.size), z])
    weight = np.sqrt(samples.count / problem.noise)
    columns *= weight
    gram, target = columns @ columns.T, columns @ (weight * samples.y)
    own = np.clip(np.searchsorted(grid, theta[n + 1 : 2 * n + 1]), 0, _GRID - 1)
    last = max(float(theta[2 * n]), float(grid[0]))
    spread = np.clip(np.searchsorted(grid, last * (np.arange(n) + 1.0) / n), 0, _GRID - 1)
    found = []
    for first in (own, spread, _greedy(gram, target, n)):
        radii = _exchanged(gram, target, _apart(first))
        weights = _weights(gram, target, radii)
        start = theta.copy()
        start[0], start[2 * n + 1] = weights[0], weights[1] if problem.free[2 * n + 1] else 0.0
        start[1 : n + 1], start[n + 1 : 2 * n + 1] = weights[2:], grid[radii]
        if not any(np.array_equal(start, each) for each in found):
            found.append(start)
    return found


def _apart(places: NDArray[np.intp]) -> NDArray[np.intp]:
    """Move places that coincide to the next free ones."""
    taken: list[int] = []
    for each in places.tolist():
        nearest = sorted(range(_GRID), key=lambda k, at=each: abs(k - at))
        taken.append(next(k for k in nearest if k not in taken))
    return np.sort(np.array(taken))


def _gains(gram: Array, target: Array, kept: NDArray[np.intp]) -> Array:
    """Give what the squares lose by one more column beside those kept, for every one on the grid."""
    base = np.concatenate([[0, 1], kept + 2])
    inner = gram[np.ix_(base, base)]
    inner = inner + 1e-10 * np.diag(np.diag(inner))
    cross = gram[base]
    solved = np.linalg.solve(inner, np.column_stack([cross, target[base]]))
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


def _weights(gram: Array, target: Array, places: NDArray[np.intp]) -> Array:
    base = np.concatenate([[0, 1], places + 2])
    inner = gram[np.ix_(base, base)]
    return np.asarray(np.linalg.solve(inner + 1e-10 * np.diag(np.diag(inner)), target[base]))

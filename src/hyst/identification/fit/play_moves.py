"""Leave the local minima that plays make beside dynamics.

A radius bends the output wherever it passes half a swing of its input, and a play that never moves,
or stands where another does, has no derivative that would lead it away. So each play in turn is
taken out and put to other places; everything else follows it in one linear step, of which only the
residual is asked. From the best place a fit is tried.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import Problem, Solution, minimize

Array = NDArray[np.float64]

SHARES = (-0.5, -0.25, -0.1, -0.03, 0.03, 0.1, 0.25, 0.5)
"""How far towards the neighbouring radius below (negative) or above each radius is moved."""

TRIAL_WEIGHT = 5e-2
"""Of all weights: what a play without any is tried with."""

MOST_ROUNDS = 6

WORTH = 3.0
"""Residual variances by which a move must lower the squared error."""


@dataclass(frozen=True)
class PlaysInChain:
    """Where the weights and radii of a bank of plays stand in theta.

    Parameters
    ----------
    weights, radii
        Places, play by play.
    reach
        Gives the largest radius a play can have and still move, for a theta.
    """

    weights: Sequence[int]
    radii: Sequence[int]
    reach: Callable[[Array], float]


def with_plays_moved(
    problem: Problem, solution: Solution, banks: Sequence[PlaysInChain], max_iterations: int
) -> Solution:
    """Improve a fit by moving its plays, until no move helps.

    Parameters
    ----------
    problem
        The least squares problem.
    solution
        A fit.
    banks
        The plays that may move.
    max_iterations
        Of the fit after each move.

    Returns
    -------
    Solution
        At least as good as ``solution``.
    """
    for _ in range(MOST_ROUNDS):
        worth = WORTH * solution.cost / problem.residual(solution.theta).size
        trials = [trial for bank in banks for trial in _trials(problem, solution.theta, bank)]
        trials = [trial for trial in trials if trial[0] < solution.cost - worth]
        if not trials or solution.cost <= problem.negligible:
            return solution
        found = minimize(problem, min(trials, key=lambda each: each[0])[1], max_iterations)
        if found.cost > solution.cost - worth:
            return solution
        solution = found
    return solution


def _trials(problem: Problem, theta: Array, bank: PlaysInChain) -> Iterator[tuple[float, Array]]:
    """Give the squared error to expect of every move, and the theta after it."""
    weights, radii = list(bank.weights), list(bank.radii)
    total = float(np.abs(theta[weights]).sum())
    reach = bank.reach(theta)
    _, jacobian = problem.linearize(theta)
    for i, (weight, radius) in enumerate(zip(weights, radii, strict=True)):
        if not problem.lower[radius] < problem.upper[radius]:
            continue
        others = np.delete(np.arange(theta.size), [weight, radius])
        basis = _basis(jacobian[:, others])
        without = theta.copy()
        without[weight] = 0.0
        left = problem.residual(without)
        plain = left - basis @ (basis.T @ left)
        for place in _places(theta[radii], i, reach, abs(theta[weight]) > 1e-3 * total):
            moved = theta.copy()
            moved[weight] = max(abs(theta[weight]), TRIAL_WEIGHT * total)
            moved[radius] = place
            column = (problem.residual(problem.canonical(moved)) - left) / moved[weight]
            column -= basis @ (basis.T @ column)
            size = float(column @ column)
            if size <= 0.0:
                continue
            best = -float(column @ plain) / size
            if problem.lower[weight] <= best <= problem.upper[weight]:
                moved[weight] = best
                yield float(plain @ plain) - best**2 * size, problem.canonical(moved)


def _places(radii: Array, i: int, reach: float, has_weight: bool) -> Array:
    """Give where to put a play: near where it is, and in every gap if it does nothing there."""
    others = np.sort(np.delete(radii, i))
    fence = np.concatenate([[0.0], others[others < reach], [reach]])
    gaps = 0.5 * (fence[1:] + fence[:-1])
    if not has_weight or radii[i] >= reach:
        return np.asarray(gaps)
    r = float(radii[i])
    at = int(np.searchsorted(fence, r))
    below, above = fence[max(at - 1, 0)], fence[min(at, fence.size - 1)]
    shares = np.array(SHARES)
    near = r + shares * np.where(shares > 0.0, above - r, r - below)
    return np.concatenate([near, gaps])


def _basis(columns: Array) -> Array:
    """Give an orthonormal basis of what columns span."""
    size = np.linalg.norm(columns, axis=0)
    kept = columns[:, size > 0.0] / size[size > 0.0]
    values, vectors = np.linalg.eigh(kept.T @ kept)
    known = values > 1e-10
    return np.asarray(kept @ (vectors[:, known] / np.sqrt(values[known])))

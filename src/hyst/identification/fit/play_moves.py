"""Leave the local minima that plays make beside dynamics.

A radius bends the output wherever it passes half a swing of its input, and a play that never moves,
or stands where another does, has no derivative that would lead it away. So each play in turn is
taken out and put to other places; everything else follows it in one linear step, of which only the
residual is asked. From the best place a fit is tried.

``moved_plays`` forecasts moves too, of a bank whose weights are sums of others and whose starts are
near: one output a move, products of columns shared by all, other radii free or not. Behind dynamics
a play may stand anywhere, what it adds at a place is the same for every play, and dynamics and
plays resemble each other so much that products lose the digits: hence columns, found once, and
their orthonormal basis.
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

PLACES = 24
"""Tried for every play, from 0 to the largest radius that moves."""

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
    weights, radii = np.array(bank.weights), np.array(bank.radii)
    _, jacobian = problem.linearize(theta)
    reach = bank.reach(theta)
    everywhere = reach * np.arange(1, PLACES + 1) / (PLACES + 1)
    weakest = int(np.argmin(np.abs(theta[weights])))
    known = list(_columns(problem, theta, bank, weakest, everywhere))
    for i in np.flatnonzero(problem.lower[radii] < problem.upper[radii]):
        weight, radius = weights[i], radii[i]
        basis = _basis(np.delete(jacobian, [weight, radius], axis=1))
        without = theta.copy()
        without[weight] = 0.0
        left = problem.residual(without)
        left -= basis @ (basis.T @ left)
        near = _columns(problem, theta, bank, int(i), _near(theta[radii], int(i), reach))
        for place, column in (*known, *near):
            seen = column - basis @ (basis.T @ column)
            size = float(seen @ seen)
            best = -float(seen @ left) / size if size > 0.0 else -np.inf
            if problem.lower[weight] <= best <= problem.upper[weight] and size > 0.0:
                moved = theta.copy()
                moved[weight], moved[radius] = best, place
                yield float(left @ left) - best**2 * size, problem.canonical(moved)


def _columns(
    problem: Problem, theta: Array, bank: PlaysInChain, i: int, places: Array
) -> Iterator[tuple[float, Array]]:
    """Give what a play adds to the output at other places, as play i tells when put there."""
    weight, radius = bank.weights[i], bank.radii[i]
    without, there = theta.copy(), theta.copy()
    without[weight] = 0.0
    there[weight] = max(
        float(np.abs(theta[weight])), TRIAL_WEIGHT * float(np.abs(theta[list(bank.weights)]).sum())
    )
    left = problem.residual(without)
    for place in places:
        there[radius] = place
        change = problem.residual(problem.canonical(there)) - left
        yield float(place), change / there[weight]


def _near(radii: Array, i: int, reach: float) -> Array:
    """Give places on the way from a play to its neighbours."""
    others = np.sort(np.delete(radii, i))
    fence = np.concatenate([[0.0], others[others < reach], [reach]])
    r, shares = float(min(radii[i], reach)), np.array(SHARES)
    at = int(np.clip(np.searchsorted(fence, r), 1, fence.size - 1))
    return np.asarray(r + shares * np.where(shares > 0.0, fence[at] - r, r - fence[at - 1]))


def _basis(columns: Array) -> Array:
    """Give an orthonormal basis of what columns span."""
    size = np.linalg.norm(columns, axis=0)
    kept = columns[:, size > 0.0] / size[size > 0.0]
    values, vectors = np.linalg.eigh(kept.T @ kept)
    known = values > 1e-10
    return np.asarray(kept @ (vectors[:, known] / np.sqrt(values[known])))

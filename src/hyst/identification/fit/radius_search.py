"""Leave the local minima that kinks make.

The output bends where a radius passes half a swing of the input, so the cost has a kink at every
half swing, some of them local minima that a derivative cannot leave. Each radius in turn is moved
across the next kinks, and some way towards its neighbours, and that of the play with least weight
between any others if it has next to none, and a short fit is tried from there.

While what the fit leaves is not white, a better minimum may lie where no linear step tells of it,
so every move is tried. As soon as it is white, only those are that promise to lower the cost by
more than a residual variance: a forecast sees what one part in a hundred of the variance hides from
the test of whiteness. Where nothing is gained the search ends.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import Problem, Solution, minimize
from hyst.identification.fit.moved_plays import MovedPlays
from hyst.identification.fit.whiteness import is_white

Array = NDArray[np.float64]

SHARES = (-0.5, -0.25, -0.1, -0.03, 0.03, 0.1, 0.25, 0.5)
"""How far towards the neighbouring radius below (negative) or above each radius is moved."""

NEXT_INTERVALS = 2
"""How many intervals between kinks are tried on either side of a radius."""

IDLE = 1e-2
"""Share of all weights up to which the play with the least is tried in every gap between others.

One, since plays without weight are as good as each other: trying all would take plays times gaps.
"""

REVIVED = 5e-2
"""Share of all weights it gets there: with next to none it would not know where to move."""

TRIAL_ITERATIONS = 2
MOST_PROMISING, MOST_OF_A_PLAY = 12, 2
"""Moves of a round that are tried where only promising ones are, and of one play of them."""

MOST_ROUNDS = 5
Move = tuple[int, Array]
"""Which play moves, counted from 0, and theta after it."""


def search_radii(
    problem: Problem,
    solution: Solution,
    basis: Array,
    kinks: Array,
    max_iterations: int,
    *,
    one_amplitude: bool = False,
) -> Solution:
    """Improve a fit by moving its radii across kinks, until no move helps.

    Parameters
    ----------
    problem
        The least squares problem; theta starts with a_0 .. a_n, r_1 .. r_n.
    solution
        A converged fit.
    basis
        Shape (n + 1, n + 1), of ``(p0, p) = basis @ a``.
    kinks
        Half swings of the input of the plays, ascending, in its units.
    max_iterations
        Of the fit after a move that helped.
    one_amplitude
        Whether all strokes are equally long: they repeat what a fit misses of them, and a few
        errors at the same places are soon taken for white ones. Then all moves are always tried.

    Returns
    -------
    Solution
        At least as good as ``solution``.
    """
    for _ in range(MOST_ROUNDS):
        residual = problem.residual(solution.theta)
        # A lower cost by one residual variance is worth it; less is within the noise.
        noise = solution.cost / residual.size
        if solution.cost <= problem.negligible:
            return solution
        moves = list(_moves(problem, solution.theta, len(basis) - 1, kinks))
        if not one_amplitude and is_white(residual):
            moves = _promising(problem, solution, basis, moves)
        trials = [minimize(problem, theta, TRIAL_ITERATIONS) for _, theta in moves]
        best = min(trials, key=lambda trial: trial.cost, default=solution)
        if best.cost > solution.cost - noise:
            return solution
        improved = minimize(problem, best.theta, max_iterations)
        solution = min(improved, best, key=lambda each: each.cost)
    return solution


def _promising(
    problem: Problem, solution: Solution, basis: Array, moves: Sequence[Move]
) -> list[Move]:
    """Give those moves that promise more than the noise, the best of all and of every play."""
    noise = solution.cost / problem.residual(solution.theta).size
    moved = MovedPlays(problem, solution.theta, basis)
    costs = np.array([moved.cost(i, float(theta[len(basis) + i])) for i, theta in moves])
    promising, of_play = list[Move](), Counter[int]()
    for k in np.argsort(costs, kind="stable"):
        i = moves[k][0]
        of_play[i] += 1
        if costs[k] < solution.cost - noise and of_play[i] <= MOST_OF_A_PLAY:
            promising.append(moves[k])
    return promising[:MOST_PROMISING]


def _moves(problem: Problem, theta: Array, plays: int, kinks: Array) -> Iterator[Move]:
    at = slice(plays + 1, 2 * plays + 1)
    r, lower, upper = theta[at], problem.lower[at], problem.upper[at]
    for i in np.flatnonzero(lower < upper):
        below = r[i - 1] if i > 0 else lower[i]
        above = r[i + 1] if i + 1 < plays else upper[i]
        shares = np.array(SHARES)
        places = r[i] + shares * np.where(shares > 0.0, above - r[i], r[i] - below)
        places = np.concatenate([places, _next_intervals(float(r[i]), kinks)])
        for place in np.unique(np.clip(places, lower[i], upper[i])):
            moved = theta.copy()
            moved[plays + 1 + i] = place
            yield int(i), moved
    yield from _revivals(theta, plays, lower, upper)


def _revivals(theta: Array, plays: int, lower: Array, upper: Array) -> Iterator[Move]:
    """Put the play with least weight, if it has next to none, into every gap between the others."""
    weights, r = theta[1 : plays + 1], theta[plays + 1 : 2 * plays + 1]
    movable = np.flatnonzero(lower < upper)
    total = float(np.abs(theta[: plays + 1]).sum())
    if movable.size == 0 or weights[movable].min() > IDLE * total:
        return
    i = int(movable[np.argmin(weights[movable])])
    for place in _gaps(np.delete(r, i), float(lower[i]), float(upper[i])):
        moved = theta.copy()
        moved[plays + 1 + i], moved[1 + i] = place, REVIVED * total
        yield i, moved


def _gaps(others: Array, lower: float, upper: float) -> Array:
    """Give the middles between the other radii, and beyond them: anywhere but where they are."""
    fence = np.concatenate([[lower], np.sort(others), [upper]])
    return np.asarray(0.5 * (fence[1:] + fence[:-1]))


def _next_intervals(r: float, kinks: Array) -> Array:
    """Give the middles of the next intervals between kinks, the one r lies in left out."""
    middles = (kinks[1:] + kinks[:-1]) / 2.0
    inside = int(np.searchsorted(kinks, r)) - 1
    near = np.arange(inside - NEXT_INTERVALS, inside + NEXT_INTERVALS + 1)
    near = near[(near >= 0) & (near < middles.size) & (near != inside)]
    return np.asarray(middles[near])

"""What it promises to move one play of a bank, at the price of one output of the model.

The play is taken out and put elsewhere with the weight that suits it there; the other parameters
follow in one linear step. So of a move only the column is new that the play adds where it comes to
stand: the others, and their products, are those of the fit, shared by all moves.

The other radii follow in one forecast and stay in another. Next to a kink a linear step promises
what no step can keep, so what it promises without any move is taken off.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import Problem

Array = NDArray[np.float64]

TRIAL_WEIGHT = 5e-2
"""Of all weights: what a play with less is tried with, for its column would be lost in rounding."""

RIDGE = 1e-10
"""Of the scaled normal matrix: columns of plays that stand close together are nearly copies."""


@dataclass(frozen=True, eq=False)
class _Without:
    """The fit without one play: what is left, and what its other columns take of anything.

    Parameters
    ----------
    kept
        Which columns follow.
    inverse, moment
        Of the lower factor of their scaled products, and their products with what is left through
        it.
    cost
        Squared errors after a linear step of what follows.
    promised
        By which a linear step lowers the squared error of the fit as it is.
    """

    kept: NDArray[np.intp]
    inverse: Array
    moment: Array
    cost: float
    promised: float


class MovedPlays:
    """Promises of moves of the plays of a fit.

    Parameters
    ----------
    problem
        The least squares problem; theta starts with a_0 .. a_n, r_1 .. r_n.
    theta
        The fit.
    basis
        Shape (n + 1, n + 1), of ``(p0, p) = basis @ a``.
    """

    def __init__(self, problem: Problem, theta: Array, basis: Array) -> None:
        self._problem, self._plays = problem, len(basis) - 1
        own = slice(0, self._plays + 1)
        self._of_weights = np.linalg.inv(basis)
        self._theta, self._weights = theta, basis @ theta[own]
        self._errors, self._columns = problem.linearize(theta)
        self._columns[:, own] = self._columns[:, own] @ self._of_weights
        self._normal = self._columns.T @ self._columns
        self._gradient = self._columns.T @ self._errors
        self._scale = np.sqrt(np.maximum(np.diag(self._normal), np.finfo(np.float64).tiny))
        self._without: dict[tuple[int, bool], _Without] = {}

    def cost(self, i: int, place: float) -> float:
        """Forecast the sum of squared residuals with one play elsewhere.

        Parameters
        ----------
        i
            Which play, counted from 0.
        place
            Its radius there.
        """
        column = self._column(i, place)
        products = self._columns.T @ column
        left = float(column @ self._errors - self._weights[1 + i] * products[1 + i])
        size = float(column @ column)
        return min(
            self._after(i, follows, products / self._scale, left, size) for follows in (True, False)
        )

    def _after(self, i: int, follows: bool, products: Array, left: float, square: float) -> float:
        """Give the least squares with a column in place of play i, the other radii free or not."""
        if (i, follows) not in self._without:
            self._without[i, follows] = self._bare(i, follows)
        bare = self._without[i, follows]
        others = products[bare.kept]
        along = bare.inverse @ others
        size, slope = square - float(along @ along), left - float(along @ bare.moment)
        if size <= RIDGE * square:
            return bare.cost + bare.promised
        best = self._possible(i, -slope / size)
        return bare.cost + bare.promised + 2.0 * slope * best + size * best**2

    def _bare(self, i: int, follows: bool) -> _Without:
        weight, weights = self._weights[1 + i], self._weights.size
        radii = np.arange(weights, 2 * weights - 1)
        own = [1 + i, weights + i] if follows else [1 + i, *radii]
        kept = np.delete(np.arange(self._theta.size), own)
        scale = self._scale[kept]
        normal = self._normal[np.ix_(kept, kept)] / np.outer(scale, scale)
        factor = np.linalg.cholesky(normal + RIDGE * np.eye(kept.size))
        inverse = np.linalg.inv(factor)
        moved = (self._gradient - weight * self._normal[1 + i])[kept] / scale
        moment, still = inverse @ moved, inverse @ (self._gradient[kept] / scale)
        errors = float(self._errors @ self._errors)
        errors += weight * float(weight * self._normal[1 + i, 1 + i] - 2.0 * self._gradient[1 + i])
        return _Without(
            kept, inverse, moment, errors - float(moment @ moment), float(still @ still)
        )

    def _column(self, i: int, place: float) -> Array:
        """Give what the play adds to the output at another place, per weight."""
        weights, errors = self._weights, self._errors
        theta = self._theta.copy()
        least = TRIAL_WEIGHT * float(np.abs(weights).sum())
        if abs(weights[1 + i]) < least:
            weights = weights.copy()
            weights[1 + i] = least
            theta[: weights.size] = self._of_weights @ weights
            errors = self._problem.residual(self._problem.canonical(theta))
        theta[weights.size + i] = place
        change = self._problem.residual(self._problem.canonical(theta)) - errors
        return np.asarray(self._columns[:, 1 + i] + change / weights[1 + i])

    def _possible(self, i: int, weight: float) -> float:
        """Give the weight within its bounds, where they are of this play alone."""
        by_weight = self._of_weights[1 + i]
        if np.count_nonzero(by_weight) > 1:
            return weight
        factor = by_weight[1 + i]
        low, high = self._problem.lower[1 + i], self._problem.upper[1 + i]
        return float(np.clip(factor * weight, low, high) / factor)

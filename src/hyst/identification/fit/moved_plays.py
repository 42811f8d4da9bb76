"""What it promises to move one play of a bank, at the price of one output of the model.

The play is taken out and put elsewhere with the weight that suits it there; all other parameters
follow in one linear step. So of a move only the column is new that the play adds where it comes to
stand: the others, and their products, are those of the fit, shared by all moves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
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
        Which columns stay.
    factor, moment
        Lower factor of their scaled products, and their products with what is left through it.
    cost
        Squared errors after a linear step of what stays.
    """

    kept: NDArray[np.intp]
    factor: Array
    moment: Array
    cost: float


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
        self._without: dict[int, _Without] = {}

    def cost(self, i: int, place: float) -> float:
        """Forecast the sum of squared residuals with one play elsewhere.

        Parameters
        ----------
        i
            Which play, counted from 0.
        place
            Its radius there.
        """
        if i not in self._without:
            self._without[i] = self._bare(i)
        bare, weight = self._without[i], float(self._weights[1 + i])
        column = self._column(i, place)
        products = self._columns.T @ column
        others = (products / self._scale)[bare.kept]
        along = scipy.linalg.solve_triangular(bare.factor, others, lower=True, check_finite=False)
        size = float(column @ column - along @ along)
        slope = float(column @ self._errors - weight * products[1 + i] - along @ bare.moment)
        if size <= RIDGE * float(column @ column):
            return bare.cost
        best = self._possible(i, -slope / size)
        return bare.cost + 2.0 * slope * best + size * best**2

    def _bare(self, i: int) -> _Without:
        weight = self._weights[1 + i]
        kept = np.delete(np.arange(self._theta.size), [1 + i, 1 + self._plays + i])
        scale = self._scale[kept]
        normal = self._normal[np.ix_(kept, kept)] / np.outer(scale, scale)
        factor = np.linalg.cholesky(normal + RIDGE * np.eye(kept.size))
        moved = (self._gradient - weight * self._normal[1 + i])[kept] / scale
        moment = scipy.linalg.solve_triangular(factor, moved, lower=True, check_finite=False)
        errors = float(self._errors @ self._errors)
        errors += weight * float(weight * self._normal[1 + i, 1 + i] - 2.0 * self._gradient[1 + i])
        return _Without(kept, factor, moment, errors - float(moment @ moment))

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

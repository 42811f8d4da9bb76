"""Levenberg-Marquardt with bounds: a projected Gauss-Newton step on the normal equations.

Invariant: every iterate lies within the bounds, and the cost never rises. The normal matrix is
small (tens of parameters), so a step costs a Cholesky factor; the record is touched only to
evaluate residual and Jacobian.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.identification.fit.bounded_quadratic import least_within
from hyst.identification.fit.normal_equations import NormalEquations

Array = NDArray[np.float64]
Linearize = Callable[[Array], tuple[Array, Array]]
"""theta -> residual (N,), Jacobian (N, m)"""

CONVERGED = "converged"
ITERATION_LIMIT = "iteration limit"

LEAST_DAMPING = 1e-12
"""Of the scaled normal matrix: it keeps the matrix numerically definite, and moves nothing."""

PATIENCE = 20
"""Steps in which the cost must fall noticeably. Longer than a row of refused steps can be."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Where the iteration ended.

    Parameters
    ----------
    theta
        Shape (m,), within the bounds.
    cost
        Sum of squared residuals.
    iterations
        Steps tried.
    status
        ``converged`` or ``iteration limit``.
    """

    theta: Array
    cost: float
    iterations: int
    status: str


@dataclass(frozen=True, eq=False)
class Problem:
    """A bounded least squares problem.

    Parameters
    ----------
    linearize
        Gives residual and Jacobian at theta.
    residual
        Gives the residual alone, which is cheaper.
    lower, upper
        Shape (m,).
    canonical
        Gives an equivalent theta in the form ``linearize`` expects (sorted radii).
    negligible
        A sum of squared residuals that is nothing but rounding.
    is_linear
        Whether the residual is an affine function of theta.
    normal
        Gives the normal equations at theta without a Jacobian of all samples, for records that are
        too long for one; None where ``linearize`` makes them.
    """

    linearize: Linearize
    residual: Callable[[Array], Array]
    lower: Array
    upper: Array
    canonical: Callable[[Array], Array]
    negligible: float = 0.0
    is_linear: bool = False
    normal: Callable[[Array], NormalEquations] | None = None

    def at(self, theta: Array) -> NormalEquations:
        """Give the normal equations at theta."""
        return (
            NormalEquations.of(*self.linearize(theta))
            if self.normal is None
            else self.normal(theta)
        )


def minimize(
    problem: Problem, theta: Array, max_iterations: int = 100, tolerance: float = 1e-3
) -> Solution:
    """Minimise the sum of squared residuals within bounds.

    Parameters
    ----------
    problem
        What to minimise.
    theta
        Start; moved into the bounds.
    max_iterations
        Steps tried at most.
    tolerance
        It has converged when a full step promises to lower the cost by less than this share of the
        residual variance, which moves no parameter by more than the root of this share of its
        standard error. Or, where kinks keep a step from what it promises, when the cost has fallen
        by less than that in the last ``PATIENCE`` steps.

    Returns
    -------
    Solution

    Notes
    -----
    Bertsekas, Projected Newton methods for optimization problems with simple constraints (1982):
    parameters on a bound whose gradient pushes outwards are held, the others take the step, and the
    result is projected. Damping follows Nielsen.
    """
    theta = problem.canonical(np.clip(theta, problem.lower, problem.upper))
    if problem.is_linear:
        return _least(problem, theta)
    here = problem.at(theta)
    cost, damping, growth = here.cost, 1e-4, 2.0
    costs = [cost]
    for iteration in range(1, max_iterations + 1):
        step, promise = _projected_step(problem, theta, here.matrix, here.gradient, damping)
        # A damped step promises little because it is short, not because there is nothing to gain.
        settled = abs(promise) * (1.0 + damping) <= tolerance * cost / here.residuals
        if settled or cost <= problem.negligible:
            return Solution(theta, cost, iteration, CONVERGED)
        trial = problem.canonical(np.clip(theta + step, problem.lower, problem.upper))
        trial_residual = problem.residual(trial)
        gain = (cost - float(trial_residual @ trial_residual)) / promise
        if promise > 0.0 and gain > 1e-4:
            theta = trial
            here = problem.at(theta)
            cost = here.cost
            damping *= max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3)
            damping = max(damping, LEAST_DAMPING)
            growth = 2.0
        else:
            damping, growth = damping * growth, growth * 2.0
            if damping > 1e12:
                return Solution(theta, cost, iteration, CONVERGED)
        costs.append(cost)
        earlier = costs[-1 - PATIENCE] if iteration >= PATIENCE else np.inf
        if earlier - cost <= tolerance * cost / here.residuals:
            return Solution(theta, cost, iteration, CONVERGED)
    return Solution(theta, cost, max_iterations, ITERATION_LIMIT)


def _least(problem: Problem, theta: Array) -> Solution:
    """Solve a linear problem: once, and once more for the digits that the normal matrix lost."""
    at = _on_a_line(problem, theta) if problem.normal is None else problem.normal
    here, refined = at(theta), theta
    for _ in range(2):
        moment = here.matrix @ refined - here.gradient
        trial = least_within(here.matrix, moment, problem.lower, problem.upper, refined)
        there = at(trial)
        if not there.cost < here.cost:
            break
        refined, here = trial, there
    return Solution(refined, here.cost, 1, CONVERGED)


def _on_a_line(problem: Problem, theta: Array) -> Callable[[Array], NormalEquations]:
    """Give the normal equations of a linear problem anywhere, from one Jacobian."""
    residual, jacobian = problem.linearize(theta)
    matrix = jacobian.T @ jacobian

    def at(there: Array) -> NormalEquations:
        errors = residual + jacobian @ (there - theta)
        return NormalEquations(matrix, jacobian.T @ errors, float(errors @ errors), errors.size)

    return at


def _projected_step(
    problem: Problem, theta: Array, normal: Array, gradient: Array, damping: float
) -> tuple[Array, float]:
    """Step of the free parameters and the decrease of the cost the linear model promises."""
    held = ((theta <= problem.lower) & (gradient > 0.0)) | (
        (theta >= problem.upper) & (gradient < 0.0)
    )
    step = np.zeros_like(theta)
    while not held.all():
        free = ~held
        matrix = normal[np.ix_(free, free)]
        scale = np.sqrt(np.maximum(np.diag(matrix), 1e-30 * max(np.diag(normal).max(), 1e-300)))
        damped = matrix / np.outer(scale, scale) + damping * np.eye(scale.size)
        step[:] = 0.0
        step[free] = -scipy.linalg.solve(damped, gradient[free] / scale, assume_a="pos") / scale
        # A parameter on its bound that the step would push out is held as well.
        stuck = free & (
            ((theta <= problem.lower) & (step < 0.0)) | ((theta >= problem.upper) & (step > 0.0))
        )
        if not stuck.any():
            break
        held |= stuck
    else:
        step[:] = 0.0
    moved = np.clip(theta + step, problem.lower, problem.upper) - theta
    return moved, -float(2.0 * gradient @ moved + moved @ normal @ moved)

"""Levenberg-Marquardt with bounds: a projected Gauss-Newton step on the normal equations.

Invariant: every iterate lies within the bounds, and the cost never rises. The normal matrix is
small (tens of parameters), so a step costs a Cholesky factor; the record is touched only to sum
the normal equations and the cost, which need neither residual nor Jacobian as a whole.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg.lapack
from numpy.typing import NDArray

from hyst.identification.fit.block import Blocks, blocks_of
from hyst.identification.fit.bounded_quadratic import least_within
from hyst.identification.fit.curvature import Curvature
from hyst.identification.fit.normal_equations import NormalEquations

Array = NDArray[np.float64]
Linearize = Callable[[Array], tuple[Array, Array]]
"""theta -> residual (N,), Jacobian (N, m)"""

CONVERGED = "converged"
ITERATION_LIMIT = "iteration limit"

LEAST_DAMPING = 1e-12
"""Of the scaled normal matrix: it keeps the matrix numerically definite, and moves nothing."""

ROUNDING_OF_COST = 1e-6
"""Of the residual variance: a linear problem whose cost falls as promised but for that is solved,
to a thousandth of a standard error."""

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
    summed
        Gives the normal equations at theta without a Jacobian in memory; they are made of
        ``linearize`` if left out.
    squares
        Gives the sum of squared residuals without a residual in memory; it is made of ``residual``
        if left out.
    blocks
        Gives what gives the derivative of the residual block by block, without a Jacobian in memory
        where the records are long; it is made of ``linearize`` if left out.
    """

    linearize: Linearize
    residual: Callable[[Array], Array]
    lower: Array
    upper: Array
    canonical: Callable[[Array], Array]
    negligible: float = 0.0
    is_linear: bool = False
    summed: Callable[[Array], NormalEquations] | None = None
    squares: Callable[[Array], float] | None = None
    blocks: Callable[[Array], Blocks] | None = None

    def normal_equations(self, theta: Array) -> NormalEquations:
        """Give the normal equations at canonical theta."""
        if self.summed is not None:
            return self.summed(theta)
        return NormalEquations.of(*self.linearize(theta))

    def blocks_at(self, theta: Array) -> Blocks:
        """Give what gives the derivative at canonical theta block by block."""
        if self.blocks is not None:
            return self.blocks(theta)
        jacobian = self.linearize(theta)[1]
        return lambda: blocks_of(jacobian, [len(jacobian)])

    def cost(self, theta: Array) -> float:
        """Give the sum of squared residuals at canonical theta."""
        if self.squares is not None:
            return self.squares(theta)
        residual = self.residual(theta)
        return float(residual @ residual)


def minimize(
    problem: Problem,
    theta: Array,
    max_iterations: int = 100,
    tolerance: float = 1e-3,
    *,
    curvature: Curvature | None = None,
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
    curvature
        Learns from the steps what the normal matrix leaves out, where steps are dear and what the
        model leaves is more than noise; None for the normal matrix alone.

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
    normal = problem.normal_equations(theta)
    damping, growth = 1e-4, 2.0
    costs = [normal.cost]
    for iteration in range(1, max_iterations + 1):
        curved = normal if curvature is None else curvature.added_to(normal)
        step, promise = projected_step(problem, theta, curved, damping)
        # A damped step promises little because it is short, not because there is nothing to gain.
        noticed = tolerance * normal.cost / normal.count
        if abs(promise) * (1.0 + damping) <= noticed or normal.cost <= problem.negligible:
            return Solution(theta, normal.cost, iteration, CONVERGED)
        trial = problem.canonical(np.clip(theta + step, problem.lower, problem.upper))
        cost = problem.cost(trial)
        gain = (normal.cost - cost) / promise
        if promise > 0.0 and gain > 1e-4:
            if iteration == max_iterations:  # the normal equations there serve no further step
                return Solution(trial, cost, iteration, ITERATION_LIMIT)
            there = problem.normal_equations(trial)
            if curvature is not None:
                curvature.learn(trial - theta, normal, there)
            theta, normal = trial, there
            damping *= max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3)
            damping = max(damping, LEAST_DAMPING)
            growth = 2.0
        else:
            damping, growth = damping * growth, growth * 2.0
            if damping > 1e12:
                return Solution(theta, normal.cost, iteration, CONVERGED)
        costs.append(normal.cost)
        earlier = costs[-1 - PATIENCE] if iteration >= PATIENCE else np.inf
        if earlier - normal.cost <= tolerance * normal.cost / normal.count:
            return Solution(theta, normal.cost, iteration, CONVERGED)
    return Solution(theta, normal.cost, max_iterations, ITERATION_LIMIT)


def _least(problem: Problem, theta: Array) -> Solution:
    """Solve a linear problem: once, and once more where the normal matrix lost digits."""
    normal = problem.normal_equations(theta)
    for _ in range(2):
        moment = normal.matrix @ theta - normal.gradient
        trial = least_within(normal.matrix, moment, problem.lower, problem.upper, theta)
        step, nothing = trial - theta, ROUNDING_OF_COST * normal.cost / normal.count
        promise = -float(step @ (2.0 * normal.gradient + normal.matrix @ step))
        if 0.0 <= promise <= nothing:
            break
        cost = problem.cost(trial)
        if not cost < normal.cost:
            break
        if abs(normal.cost - cost - promise) <= nothing:
            return Solution(trial, cost, 1, CONVERGED)
        theta, normal = trial, problem.normal_equations(trial)
    return Solution(theta, normal.cost, 1, CONVERGED)


def projected_step(
    problem: Problem, theta: Array, normal: NormalEquations, damping: float
) -> tuple[Array, float]:
    """Give the step of the free parameters, and the decrease of the cost the linear model promises.

    Parameters
    ----------
    problem
        For its bounds.
    theta
        Within them.
    normal
        The normal equations there.
    damping
        Of the scaled normal matrix.
    """
    matrix, gradient = normal.matrix, normal.gradient
    at_lower, at_upper = theta <= problem.lower, theta >= problem.upper
    free = ~((at_lower & (gradient > 0.0)) | (at_upper & (gradient < 0.0)))
    diagonal = matrix.diagonal()
    scale = np.sqrt(np.maximum(diagonal, 1e-30 * max(float(diagonal.max()), 1e-300)))
    damped = matrix / scale[:, None] / scale
    damped.flat[:: len(damped) + 1] += damping
    while free.any():
        step = _solved(damped, -gradient / scale, free) / scale
        # A parameter on its bound that the step would push out is held as well.
        stuck = free & ((at_lower & (step < 0.0)) | (at_upper & (step > 0.0)))
        if not stuck.any():
            break
        free &= ~stuck
    else:
        step = np.zeros_like(theta)
    moved = np.clip(theta + step, problem.lower, problem.upper) - theta
    return moved, -float(2.0 * gradient @ moved + moved @ matrix @ moved)


def _solved(matrix: Array, right: Array, free: NDArray[np.bool_]) -> Array:
    """Solve for the free unknowns of a positive definite system, the others being 0."""
    solution = np.zeros_like(right)
    if not free.all():
        places = np.flatnonzero(free)
        matrix, right = matrix[places[:, None], places], right[places]
    # The routine itself: what scipy.linalg asks before it takes ten times as long.
    posv = scipy.linalg.lapack.dposv
    _, found, failed = posv(np.asarray_chkfinite(matrix), right)
    ridge = LEAST_DAMPING
    while failed:  # rounding has made it indefinite
        ridge *= 10.0
        _, found, failed = posv(matrix + ridge * np.eye(len(matrix)), right)
    solution[free] = found
    return solution

"""The bounded solver against scipy's on random problems."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares, lsq_linear

from hyst.identification.fit.bounded_least_squares import (
    CONVERGED,
    ITERATION_LIMIT,
    Problem,
    minimize,
)


def linear_problem(seed: int, columns: int = 6) -> tuple[Problem, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    matrix, target = rng.normal(size=(40, columns)), rng.normal(size=40)
    lower, upper = -rng.uniform(0.0, 0.2, columns), rng.uniform(0.0, 0.2, columns)
    problem = Problem(
        lambda theta: (matrix @ theta - target, matrix),
        lambda theta: matrix @ theta - target,
        lower,
        upper,
        lambda theta: theta,
    )
    return problem, matrix, target


@pytest.mark.parametrize("seed", range(20))
def test_linear_problems_with_active_bounds(seed: int) -> None:
    problem, matrix, target = linear_problem(seed)
    found = minimize(problem, np.zeros(6), tolerance=1e-10)
    expected = lsq_linear(matrix, target, (problem.lower, problem.upper), tol=1e-12)
    assert found.status == CONVERGED
    assert found.cost == pytest.approx(2.0 * expected.cost, rel=1e-8)
    assert (found.theta >= problem.lower).all()
    assert (found.theta <= problem.upper).all()


def test_a_curved_problem() -> None:
    """Rosenbrock's valley, with a bound that cuts off the minimum."""

    def residual(theta: np.ndarray) -> np.ndarray:
        return np.array([10.0 * (theta[1] - theta[0] ** 2), 1.0 - theta[0]])

    def linearize(theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return residual(theta), np.array([[-20.0 * theta[0], 10.0], [-1.0, 0.0]])

    lower, upper = np.array([-2.0, -2.0]), np.array([0.8, 2.0])
    found = minimize(
        Problem(linearize, residual, lower, upper, lambda t: t), np.array([-1.2, 1.0]), 200, 1e-12
    )
    expected = least_squares(residual, [-1.2, 0.9], bounds=(lower, upper), xtol=1e-14, ftol=1e-14)
    np.testing.assert_allclose(found.theta, expected.x, atol=1e-6)


def test_a_redundant_parameter_does_no_harm() -> None:
    rng = np.random.default_rng(3)
    column = rng.normal(size=30)
    matrix = np.column_stack([column, column])
    problem = Problem(
        lambda t: (matrix @ t - 2.0 * column, matrix),
        lambda t: matrix @ t - 2.0 * column,
        np.full(2, -np.inf),
        np.full(2, np.inf),
        lambda t: t,
    )
    found = minimize(problem, np.zeros(2))
    assert found.theta.sum() == pytest.approx(2.0, abs=1e-4)


def test_says_when_it_ran_out_of_iterations() -> None:
    problem, _, _ = linear_problem(0)
    assert minimize(problem, np.zeros(6), max_iterations=1).status == ITERATION_LIMIT


def test_a_cost_that_hardly_falls_any_more_has_converged() -> None:
    """Kinks make steps keep a small share of what they promise, here by a Jacobian 2000 times off.

    Every step is accepted and shorter than the last, so the promise alone would never settle.
    """
    problem = Problem(
        lambda theta: (1.0 - 1e-5 * theta, np.array([[-0.02]])),
        lambda theta: 1.0 - 1e-5 * theta,
        np.full(1, -np.inf),
        np.full(1, np.inf),
        lambda theta: theta,
    )
    found = minimize(problem, np.zeros(1), 100)
    assert found.status == CONVERGED
    assert found.iterations < 50

"""Steps to where the gradient of a rough cost vanishes."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import CONVERGED, ITERATION_LIMIT, Problem
from hyst.identification.fit.normal_equations import NormalEquations
from hyst.identification.stream.settling import settle

Array = NDArray[np.float64]
SAMPLES = 1_000_000
TRUE = np.array([2.0, 0.5])
ERRORS = np.array([1e-3, 2e-4])
"""Standard errors: the variance of the residual is 1."""
MATRIX = np.array([[1.0, 0.6], [0.6, 1.0]]) / np.outer(ERRORS, ERRORS)
START = TRUE + 20.0 * ERRORS


def problem(height: float, width: float = 3e-5) -> Problem:
    """A quadratic with teeth of some height, in residual variances, over its last parameter."""

    def squares(theta: Array) -> float:
        away, phase = theta - TRUE, (theta[1] / width) % 1.0
        return SAMPLES + float(away @ MATRIX @ away) + height * abs(2.0 * phase - 1.0)

    def summed(theta: Array) -> NormalEquations:
        slope = 2.0 * height / width * np.sign((theta[1] / width) % 1.0 - 0.5)
        gradient = MATRIX @ (theta - TRUE) + np.array([0.0, 0.5 * slope])
        return NormalEquations(MATRIX, gradient, squares(theta), SAMPLES)

    def refused(theta: Array) -> Array:
        raise AssertionError("no residual of so many samples")

    none = np.full(2, np.inf)
    canonical = np.copy
    return Problem(refused, refused, -none, none, canonical, summed=summed, squares=squares)


def test_without_teeth_derivatives_lead_there() -> None:
    found = settle(problem(0.0), [problem(0.0)], START, (1,), 20)
    assert found.by == -1
    assert found.solution.status == CONVERGED
    assert (np.abs(found.solution.theta - TRUE) <= 0.1 * ERRORS).all()


@pytest.mark.parametrize("height", [30.0, 1000.0])
def test_across_teeth_secants_lead_there(height: float) -> None:
    found = settle(problem(height), [problem(0.0)], START, (1,), 20)
    assert found.by == 0
    assert found.solution.status == CONVERGED
    assert (np.abs(found.solution.theta - TRUE) <= 0.1 * ERRORS).all()


def test_wider_secants_are_asked_where_narrow_ones_mislead() -> None:
    found = settle(problem(1000.0), [problem(300.0), problem(0.0)], START, (1,), 40)
    assert found.by == 1
    assert found.solution.status == CONVERGED
    assert (np.abs(found.solution.theta - TRUE) <= 0.1 * ERRORS).all()


def test_where_nothing_leads_there_it_is_not_said_to_have_settled() -> None:
    found = settle(problem(1000.0), [problem(1000.0)], START, (1,), 40)
    assert found.solution.status == ITERATION_LIMIT
    # What is told to be left is no less than what is.
    assert (np.abs(found.left) >= np.abs(found.solution.theta - TRUE)).any()


def test_it_ends_after_so_many_steps() -> None:
    found = settle(problem(0.0), [problem(0.0)], START, (1,), 0)
    assert found.solution.iterations == 0
    assert found.solution.status == ITERATION_LIMIT
    np.testing.assert_allclose(found.left, TRUE - START, rtol=1e-6)

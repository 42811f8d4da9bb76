"""Coefficients of dynamics, their derivatives, and the gauge of their gain."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.identification.families.hammerstein.coefficients import (
    coefficients,
    coefficients_by_theta,
)
from hyst.identification.families.hammerstein.joint import JointParametrization, joint
from hyst.identification.fit.parametrization import Parametrization
from hyst.models import LinearDynamics
from hyst.operators import Affine

DT = 1e-3
POLES = [0.9, 0.6 + 0.5j, 0.6 - 0.5j, -0.2]


def realization(seed: int = 0, feedthrough: float = 0.3) -> LinearDynamics:
    """Dynamics of order four in coordinates of no kind."""
    rng = np.random.default_rng(seed)
    plain = LinearDynamics.from_zeros_poles_gain([0.3, -0.4], POLES, 1.0, DT)
    T = rng.normal(size=(4, 4)) + 3.0 * np.eye(4)
    A = np.linalg.solve(T, plain.A @ T)
    G = LinearDynamics(A, np.linalg.solve(T, plain.B), plain.C @ T, feedthrough, DT)
    return G.in_units(1.0, 1.0 / G.dc_gain())


def joined(base: LinearDynamics) -> tuple[JointParametrization, np.ndarray]:
    """Dynamics behind a line."""
    free = np.full(2, np.inf)
    line = Parametrization(Affine(2.0, 0.5), np.eye(2), np.zeros(2), -free, free)
    parametrization, theta = joint((line, np.array([2.0, 0.5])), base)
    assert isinstance(parametrization, JointParametrization)
    return parametrization, theta


def central(function: object, theta: np.ndarray, step: float = 1e-6) -> np.ndarray:
    """Derivative of a function of theta by central differences."""
    columns = [
        (function(theta + shift) - function(theta - shift)) / (2.0 * step)  # type: ignore[operator]
        for shift in step * np.eye(theta.size)
    ]
    return np.array(columns).T


def test_coefficients_are_those_of_the_transfer_function() -> None:
    num, den = [0.5, 0.2, -0.1], [1.0, -1.2, 0.5]
    G = LinearDynamics.from_transfer_function(num, den, DT)
    assert coefficients(G) == pytest.approx([-1.2, 0.5, *num], abs=1e-14)


@pytest.mark.parametrize("feedthrough", [0.3, 0.0])
def test_derivatives_are_those_of_differences(feedthrough: float) -> None:
    base = realization(feedthrough=feedthrough)
    parametrization, theta = joined(base)
    theta[2:6] += 0.01 * np.arange(4.0)  # somewhere beside the realization itself
    dynamics = parametrization.dynamics(theta)
    free = feedthrough != 0.0
    # Central differences of step 1e-6 keep half of the digits.
    by_theta = central(lambda t: coefficients(parametrization.dynamics(t)), theta)[:, 2:]
    assert coefficients_by_theta(dynamics, free) == pytest.approx(by_theta, abs=1e-7)
    assert parametrization.gauges is not None
    by_theta = central(lambda t: parametrization.gauges(t)[0], theta)  # type: ignore[misc]
    assert parametrization.gauges(theta)[1] == pytest.approx(by_theta, abs=1e-6)


def test_constants_are_those_of_hysteresis_and_dynamics() -> None:
    parametrization, theta = joined(realization())
    theta[2:6] += 0.01
    whole = parametrization.dynamics(theta) @ parametrization.hysteresis(theta)
    expected = whole.parameters().values
    assert parametrization.operator(theta).parameters().values == pytest.approx(expected, abs=1e-15)


def test_units_leave_the_dynamics_as_they_are() -> None:
    """A line keeps the unit of its signal as a map, but not in front of dynamics of gain 1."""
    parametrization, theta = joined(realization())
    scaled = parametrization.in_units(theta, 4.0, 32.0)
    u = np.random.default_rng(1).normal(size=200)
    plain = parametrization.operator(theta)(u)
    assert scaled.operator(theta)(4.0 * u) == pytest.approx(32.0 * plain, abs=1e-12)
    assert scaled.dynamics(theta) == parametrization.dynamics(theta)
    assert scaled.hysteresis(theta)(4.0 * u) == pytest.approx(32.0 * (2.0 * u + 0.5), abs=1e-12)


def test_what_is_not_stable_is_no_model() -> None:
    parametrization, theta = joined(realization())
    assert parametrization.is_allowed is not None
    assert parametrization.is_allowed(theta)
    theta[2:6] += 10.0
    assert not parametrization.is_allowed(theta)

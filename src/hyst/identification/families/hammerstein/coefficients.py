"""Coefficients of dynamics, which people are told, with their exact derivative.

With ``A = A0 + B0 k'`` the numerator ``adj(z - A) B0`` of the states does not depend on k, so the
coefficients of ``sum b_i q^-i / (1 + sum a_i q^-i)`` are affine in k, C and D a.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.estimates import Estimates
from hyst.identification.families.hammerstein.joint import JointParametrization
from hyst.models import LinearDynamics

Array = NDArray[np.float64]


def coefficients(dynamics: LinearDynamics) -> Array:
    """Give ``a_1 .. a_n, b_0 .. b_n`` of ``sum b_i q^-i / (1 + sum a_i q^-i)``, without delay.

    Parameters
    ----------
    dynamics
        Of order n.
    """
    a = _denominator(dynamics)
    return np.concatenate(
        [a[1:], np.append(0.0, dynamics.C @ _numerators(dynamics)) + dynamics.D * a]
    )


def coefficients_by_theta(dynamics: LinearDynamics, feedthrough: bool) -> Array:
    """Give the derivative of the coefficients by k, C and D.

    Parameters
    ----------
    dynamics
        Of order n.
    feedthrough
        Whether D is free.

    Returns
    -------
    numpy.ndarray
        Shape (2 n + 1, 2 n), or one column more.
    """
    n, a, states = dynamics.order, _denominator(dynamics), _numerators(dynamics).T
    result = np.zeros((2 * n + 1, 2 * n + 1))
    result[:n, :n] = -states
    result[n + 1 :, :n] = -dynamics.D * states
    result[n + 1 :, n : 2 * n] = states
    result[n:, -1] = a
    return result if feedthrough else result[:, :-1]


def _denominator(dynamics: LinearDynamics) -> Array:
    return np.atleast_1d(np.poly(dynamics.A)).real


def _numerators(dynamics: LinearDynamics) -> Array:
    """Give the coefficients of ``adj(z - A) B``, falling powers from n - 1, shape (n, n)."""
    a, columns, power = _denominator(dynamics), [], np.zeros(dynamics.order)
    for each in a[:-1]:
        power = dynamics.A @ power + each * dynamics.B
        columns.append(power)
    return np.array(columns).T.reshape(dynamics.order, dynamics.order)


def estimates_with_dynamics(
    front: Estimates, parametrization: JointParametrization, dynamics: LinearDynamics
) -> Estimates:
    """Give the constants of a hysteresis and the coefficients of the dynamics behind it.

    Parameters
    ----------
    front
        Of the hysteresis.
    parametrization, dynamics
        Of both, and the dynamics it makes.
    """
    if parametrization.held:
        return front
    n, first = dynamics.order, parametrization.front.size
    by_dynamics = coefficients_by_theta(dynamics, parametrization.feedthrough)
    by_theta = np.zeros((len(front.names) + len(by_dynamics), parametrization.size))
    by_theta[: len(front.names), :first] = front.by_theta
    by_theta[len(front.names) :, first:] = by_dynamics
    names = [f"dynamics.a[{i}]" for i in range(1, n + 1)]
    names += [f"dynamics.b[{i}]" for i in range(n + 1)]
    values = np.concatenate([front.values, coefficients(dynamics)])
    return Estimates((*front.names, *names), values, by_theta)

"""Standard errors of everything that was refined together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.joint import (
    Joint,
    derivative,
    simulated,
    within_gauges,
)
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.covariance import robust_covariance, undetermined_combination
from hyst.models import LinearDynamics

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Covariance of theta and the parameters that have none.

    Parameters
    ----------
    covariance
        Shape (m, m); zero for parameters on a bound.
    known
        Shape (m,): False for parameters on a bound or not determined.
    noise_rms
        Of the residual, output units.
    """

    covariance: Array
    known: NDArray[np.bool_]
    noise_rms: float


def uncertainty(joint: Joint, data: Data, theta: Array) -> Uncertainty:
    """Estimate the covariance of theta, the gauges held.

    Parameters
    ----------
    joint, data, theta
        Where the refinement ended.

    Returns
    -------
    Uncertainty
    """
    lower, upper = joint.bounds()
    inside = (theta > lower) & (theta < upper)
    inside[joint.front_size :] = True
    jacobian = derivative(joint, data, theta)
    residual = simulated(joint, data, theta) - data.measured()
    lengths = [window.stop - window.start for window in data.windows()]
    inside &= np.abs(jacobian).max(axis=0) > 0.0
    while True:
        basis = within_gauges(joint, theta, inside)
        reduced = jacobian @ basis
        share = undetermined_combination(reduced)
        if share is None:
            break
        # The parameter with the largest part in what cannot be told apart has no standard error.
        parts = np.abs(basis @ share)
        parts[joint.front_size :] = 0.0
        if not parts.any():
            return Uncertainty(np.zeros((theta.size,) * 2), np.zeros(theta.size, bool), 0.0)
        inside[int(parts.argmax())] = False
    covariance = basis @ robust_covariance(reduced, residual, lengths) @ basis.T
    freedom = max(residual.size - basis.shape[1], 1)
    noise = float(np.sqrt(residual @ residual / freedom))
    return Uncertainty(covariance, inside, noise)


def coefficients(dynamics: LinearDynamics) -> Array:
    """Give ``a_1 .. a_n, b_0 .. b_n`` of ``sum b_i q^-i / (1 + sum a_i q^-i)``, without delay."""
    a = np.atleast_1d(np.poly(dynamics.A)).real
    zero_delay = LinearDynamics(dynamics.A, dynamics.B, dynamics.C, dynamics.D, dynamics.dt)
    b = np.convolve(a, zero_delay.impulse_response(a.size))[: a.size]
    return np.concatenate([a[1:], b])


def poles_as_numbers(dynamics: LinearDynamics) -> Array:
    """Give real parts, then imaginary parts, of the poles in a settled order."""
    poles = np.linalg.eigvals(dynamics.A)
    poles = poles[np.lexsort((poles.imag, poles.real))]
    return np.concatenate([poles.real, poles.imag])


def spread_of(
    joint: Joint, theta: Array, covariance: Array, quantity: Callable[[LinearDynamics], Array]
) -> Array:
    """Give the standard errors of a function of the dynamics, by its derivative.

    Parameters
    ----------
    joint, theta, covariance
        Where, and how sure.
    quantity
        Gives a vector for dynamics.

    Returns
    -------
    numpy.ndarray
        Shape of the vector.
    """
    first = joint.front_size
    scale = np.sqrt(np.maximum(np.diag(covariance), 0.0))[first:]
    rows = []
    for i, size in enumerate(scale):
        step = max(1e-3 * float(size), 1e-7 * max(1.0, abs(float(theta[first + i]))))
        shift = np.zeros(theta.size)
        shift[first + i] = step
        up = quantity(joint.dynamics(theta + shift))
        down = quantity(joint.dynamics(theta - shift))
        rows.append((up - down) / (2.0 * step))
    by_theta = np.array(rows).T
    variance = np.einsum("ij,jk,ik->i", by_theta, covariance[first:, first:], by_theta)
    return np.asarray(np.sqrt(np.maximum(variance, 0.0)))

"""Free parameters of hysteresis and dynamics together.

The dynamics keep the well-conditioned coordinates of their realization: ``A = A0 + B0 k'``,
``B = B0``, C and D free. That reaches every system of the order with 2n + 1 numbers, and the
constants are an affine function of them. What data cannot determine, the factor between hysteresis
and dynamics, is a gauge: the dynamics' gain at rest is 1.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit, Start
from hyst.identification.families.hammerstein.start.ringing import Ringing
from hyst.identification.fit.nuisance import Nuisances
from hyst.identification.fit.parametrization import Parametrization
from hyst.models import LinearDynamics
from hyst.operators import Operator

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JointParametrization(Parametrization):
    """A parametrization that knows hysteresis and dynamics; theta starts with the hysteresis'.

    Parameters
    ----------
    front
        Free parameters of the hysteresis.
    base
        Realization whose coordinates are kept; stable.
    feedthrough
        Whether D is free; it is 0 otherwise.
    held
        Whether the dynamics are known: then none of their parameters is free.
    """

    front: Parametrization = None  # type: ignore[assignment]  # the fields before have defaults
    base: LinearDynamics = None  # type: ignore[assignment]
    feedthrough: bool = True
    held: bool = False

    def hysteresis(self, theta: Array) -> Operator:
        """Give the hysteresis."""
        return self.front.operator(theta[: self.front.size])

    def dynamics(self, theta: Array) -> LinearDynamics:
        """Give the dynamics."""
        base = self.base
        if self.held:
            return base
        A, C, D = _matrices(theta[self.front.size :], base, self.feedthrough)
        return LinearDynamics(A, base.B, C, D, base.dt, base.delay)

    def over_theta(self, by_dynamics: Array) -> Array:
        """Give a derivative by k, C and D as one by theta; nothing moves dynamics that are held."""
        result = np.zeros((len(by_dynamics), self.size))
        if not self.held:
            result[:, self.front.size :] = by_dynamics
        return result

    def seen_by_front(self) -> Parametrization:
        """Give the same free parameters for the family of the hysteresis: its own come first."""
        taken = {each.name: getattr(self, each.name) for each in fields(Parametrization)}
        return replace(self.front, **taken)

    def in_units(self, theta: Array, input_scale: float, output_scale: float) -> Self:
        """Give the same free parameters in other units, which the hysteresis alone takes."""
        front = self.front.in_units(theta[: self.front.size], input_scale, output_scale)
        constants = front.fixed.size
        scaled = self.transform.copy()
        scaled[:constants, : front.size] = front.transform
        return replace(
            self,
            template=self.base @ front.template,
            transform=scaled,
            fixed=np.concatenate([front.fixed, self.fixed[constants:]]),
            front=front,
        )


def joint(front: Start, base: LinearDynamics) -> Start:
    """Give the free parameters of hysteresis and dynamics together, and where to start.

    Parameters
    ----------
    front
        Of the hysteresis.
    base
        Dynamics to start from; stable, of gain 1 at rest. Their D is free unless it is 0.

    Returns
    -------
    JointParametrization
    theta : numpy.ndarray
    """
    hysteresis, theta = front
    n, first, feedthrough = base.order, hysteresis.size, base.D != 0.0
    count = 2 * n + int(feedthrough)
    by_dynamics = np.zeros((n * n + 2 * n + 1, count))
    by_dynamics[: n * n, :n] = np.kron(base.B[:, None], np.eye(n))
    by_dynamics[n * n + n : n * n + 2 * n, n : 2 * n] = np.eye(n)
    by_dynamics[n * n + 2 * n :, 2 * n :] = 1.0
    fixed = np.concatenate([base.A.ravel(), base.B, np.zeros(n + 1)])
    transform = np.zeros((hysteresis.fixed.size + fixed.size, first + count))
    transform[: hysteresis.fixed.size, :first] = hysteresis.transform
    transform[hysteresis.fixed.size :, first:] = by_dynamics
    free = np.full(count, np.inf)
    parametrization = JointParametrization(
        template=base @ hysteresis.template,
        transform=transform,
        fixed=np.concatenate([hysteresis.fixed, fixed]),
        lower=np.concatenate([hysteresis.lower, -free]),
        upper=np.concatenate([hysteresis.upper, free]),
        canonical=partial(_canonical, hysteresis),
        gauges=partial(_gauges, hysteresis, base, feedthrough),
        gauge_count=1 + hysteresis.gauge_count,
        nuisances=Nuisances((Ringing(base, first),)) if n else None,
        is_allowed=partial(_is_allowed, hysteresis, base, feedthrough),
        front=hysteresis,
        base=base,
        feedthrough=feedthrough,
    )
    D = np.full(int(feedthrough), base.D)
    return parametrization, np.concatenate([theta, np.zeros(n), base.C, D])


def joint_of(fit: Fit) -> JointParametrization:
    """Give the free parameters of a fit of hysteresis and dynamics.

    Parameters
    ----------
    fit
        Made from ``joint``.
    """
    parametrization = fit.parametrization
    assert isinstance(parametrization, JointParametrization), "Hammerstein made it"
    return parametrization


def dynamics_of(fit: Fit) -> LinearDynamics:
    """Give the dynamics of a fit of hysteresis and dynamics."""
    return joint_of(fit).dynamics(fit.solution.theta)


def _matrices(theta: Array, base: LinearDynamics, feedthrough: bool) -> tuple[Array, Array, float]:
    """Give A, C and D."""
    k, c, d = np.split(theta, [base.order, 2 * base.order])
    return base.A + np.outer(base.B, k), c, float(d[0]) if feedthrough else 0.0


def _canonical(front: Parametrization, theta: Array) -> Array:
    return np.concatenate([front.canonical(theta[: front.size]), theta[front.size :]])


def _is_allowed(
    front: Parametrization, base: LinearDynamics, feedthrough: bool, theta: Array
) -> bool:
    """No model of a stable actuator is unstable."""
    A, _, _ = _matrices(theta[front.size :], base, feedthrough)
    stable = bool(np.abs(np.linalg.eigvals(A)).max(initial=0.0) < 1.0)
    return stable and (front.is_allowed is None or front.is_allowed(theta[: front.size]))


def _gauges(
    front: Parametrization, base: LinearDynamics, feedthrough: bool, theta: Array
) -> tuple[Array, Array]:
    n, first = base.order, front.size
    A, C, D = _matrices(theta[first:], base, feedthrough)
    x = np.linalg.solve(np.eye(n) - A, base.B)
    row = np.zeros((1, theta.size))
    row[0, first : first + n] = float(C @ x) * x
    row[0, first + n : first + 2 * n] = x
    row[0, first + 2 * n :] = 1.0
    value = np.array([float(C @ x) + D - 1.0])
    if front.gauges is None:
        return value, row
    more, rows = front.gauges(theta[:first])
    rows = np.pad(rows, ((0, 0), (0, theta.size - first)))
    return np.concatenate([value, more]), np.concatenate([row, rows])

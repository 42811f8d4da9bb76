"""A hysteresis of plays on a grid of radii before dynamics: any weights, any offset."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Start
from hyst.identification.families.hammerstein.joint import JointParametrization, joint
from hyst.identification.families.hammerstein.start.at_full_rate import Dynamic
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.parametrization import Parametrization, selection
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics, PrandtlIshlinskii
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]

_TOLERANCE = 1.0  # of the residual variance


@dataclass(frozen=True, eq=False)
class OnGrid:
    """Dynamics refined together with a hysteresis of plays on a grid.

    Parameters
    ----------
    dynamics
        Of gain 1 at rest.
    hysteresis
        Plays and offset.
    cost
        Mean squared error over the samples compared.
    errors
        Shape (samples,), what is left of each.
    further
        The same with a pair of poles more, which did not pay; None if it was not tried.
    """

    dynamics: LinearDynamics
    hysteresis: Operator
    cost: float
    errors: Array
    further: OnGrid | None = None


def grid_front(radii: Array, weights: Array, offset: float) -> Start:
    """Give free parameters of plays on a grid of radii.

    Parameters
    ----------
    radii
        Shape (m - 1,), input units; held.
    weights
        Shape (m,), of the input and the plays.
    offset
        Output units.
    """
    template = Affine(1.0, offset) @ PrandtlIshlinskii(weights[1:], radii, weights[0])
    values = template.parameters().values
    count = weights.size
    places = [*range(count), values.size - 1]
    free = np.full(count + 1, np.inf)
    fixed = values.copy()
    fixed[places] = 0.0
    made = Parametrization(template, selection(values.size, places), fixed, -free, free)
    return made, values[places]


def refined_on_grid(
    data: Data, radii: Array, found: Dynamic, feedthrough: bool, iterations: int
) -> OnGrid:
    """Lower the output error over dynamics and weights of plays on a grid.

    Parameters
    ----------
    data
        The records.
    radii
        Of the grid, input units.
    found
        Where to start.
    feedthrough
        Whether the first sample after the delay may answer: as many numbers of G more as a delay
        that is no whole number of samples needs.
    iterations
        At most.
    """
    G = found.dynamics
    gain = G.dc_gain()
    D = G.D / gain if feedthrough else 0.0
    if feedthrough and D == 0.0:
        D = 1e-12
    base = LinearDynamics(G.A, G.B, G.C / gain, D, G.dt, G.delay)
    level = float(data.measured().mean())
    front = grid_front(radii, gain * found.weights, level)
    parametrization, theta = joint(front, base)
    problem = problem_of(data, parametrization)
    solution = minimize(problem, theta, iterations, _TOLERANCE)
    errors = problem.residual(solution.theta)[: data.measured().size]
    assert isinstance(parametrization, JointParametrization), "joint made it"
    return OnGrid(
        parametrization.dynamics(solution.theta),
        parametrization.hysteresis(solution.theta),
        float(errors @ errors) / errors.size,
        errors,
    )

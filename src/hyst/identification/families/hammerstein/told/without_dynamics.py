"""Whether the dynamics explain anything: the final fit against its hysteresis alone."""

from __future__ import annotations

import contextlib

import numpy as np

from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import shortened
from hyst.identification.families.hammerstein.joint import dynamics_of, joint_of
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.problem import model_output, problem_of
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

_SAMPLES = 50_000
_ITERATIONS = 60
_KNOWN_TO = 0.01  # the fit ends where a dozen steps lower the squared error by less
_BY_CHANCE = 10.0  # squared errors of noise that each constant of G may fit, 1 on average
_LONGEST_LAG = 1000  # beside the delay
_ROUNDING = 1e-10  # share of the output's power: both explain everything


def dynamics_doubts(fit: Fit, front: Family, data: Data) -> tuple[str, ...]:
    """Say so if hysteresis alone, with G = 1 and a delay, explains the output as well.

    Parameters
    ----------
    fit
        Hysteresis and dynamics.
    front
        Family of the hysteresis.
    data
        The records, in the units of the fit.

    Returns
    -------
    tuple of str
        A sentence, or nothing.
    """
    short = shortened(data, max(_SAMPLES // len(data.records), 1))
    measured, dynamics = short.measured(), dynamics_of(fit)
    error = model_output(short, fit.operator) - measured
    with_dynamics = float(error @ error)
    lag = _lag(dynamics)
    alone = min(_alone(fit, front, short, delay) for delay in {0, lag})
    power = float(np.square(measured - measured.mean()).sum())
    count = 2 * dynamics.order + 1
    share = max(_KNOWN_TO, _BY_CHANCE * count / measured.size)
    if alone > max(with_dynamics / (1.0 - share), _ROUNDING * power):
        return ()
    return (
        f"the dynamics explain nothing: hysteresis alone leaves {np.sqrt(alone / error.size):.3g} "
        f"rms, with G of order {dynamics.order} it is {np.sqrt(with_dynamics / error.size):.3g}; "
        "do not use the poles, and identify with the family of the hysteresis instead",
    )


def _lag(dynamics: LinearDynamics) -> int:
    """Give the samples by which the output lags most: where the impulse response peaks."""
    response = dynamics.impulse_response(dynamics.delay + _LONGEST_LAG)
    return int(np.abs(response).argmax())


def _alone(fit: Fit, front: Family, data: Data, delay: int) -> float:
    """Squared error of the hysteresis alone, from its constants in the fit and from a new start."""
    late = data.delayed(delay)
    parametrization = joint_of(fit).front
    starts: list[Start] = [(parametrization, fit.solution.theta[: parametrization.size])]
    with contextlib.suppress(NotIdentifiableError):  # the output may show no such hysteresis
        starts += front.starts(Overview(late, rates_matter=True), fit.size, 1)
    root = front.root_weights(late)
    problems = [(problem_of(late, each, None, root), theta) for each, theta in starts]
    costs = [minimize(problem, theta, _ITERATIONS, 1.0).cost for problem, theta in problems]
    # The first samples are compared by the refined model only.
    return min(costs) * data.measured().size / late.measured().size

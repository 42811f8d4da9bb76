"""Whether the dynamics explain anything: the refined model against its hysteresis alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.front import FrontOptions, first_front
from hyst.identification.families.hammerstein.joint import Joint, shortened, simulated
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

_SAMPLES = 50_000
_ITERATIONS = 60
_KNOWN_TO = 0.01  # the refinement ends where a dozen steps lower the squared error by less
_BY_CHANCE = 10.0  # squared errors of noise that each constant of G may fit, 1 on average
_ROUNDING = 1e-10  # share of the output's power: both explain everything


def dynamics_doubts(
    joint: Joint, data: Data, theta: Array, lag: int, options: FrontOptions
) -> tuple[str, ...]:
    """Say so if hysteresis alone, with G = 1 and a delay, explains the output as well.

    Parameters
    ----------
    joint, theta
        The refined model.
    data
        The records.
    lag
        Samples by which the output lags most, where the impulse response peaks.
    options
        The hysteresis wanted.

    Returns
    -------
    tuple of str
        A sentence, or nothing.
    """
    short = shortened(data, _SAMPLES // len(data.records))
    measured = short.measured()
    error = simulated(joint, short, theta) - measured
    with_dynamics = float(error @ error)
    alone = min(_alone(joint, short, theta, delay, options) for delay in {0, lag})
    power = float(np.square(measured - measured.mean()).sum())
    count = 2 * joint.base.order + 1
    share = max(_KNOWN_TO, _BY_CHANCE * count / measured.size)
    if alone > max(with_dynamics / (1.0 - share), _ROUNDING * power):
        return ()
    return (
        f"the dynamics explain nothing: hysteresis alone leaves {np.sqrt(alone / error.size):.3g} "
        f"rms, with G of order {joint.base.order} it is {np.sqrt(with_dynamics / error.size):.3g}; "
        "do not use the poles, and identify with the family of the hysteresis instead",
    )


def _alone(joint: Joint, data: Data, theta: Array, delay: int, options: FrontOptions) -> float:
    """Squared error of the hysteresis alone, from the refined constants and from a fit to y."""
    first, late = data.records[0], data.delayed(delay)
    direct = first_front(first.u[: len(first) - delay], first.y[delay:], first.dt, options)
    costs = []
    for front in (replace(joint.front, theta=theta[: joint.front_size]), direct):
        problem = problem_of(late, front.parametrization)
        costs.append(minimize(problem, front.theta, _ITERATIONS, 1.0).cost)
    # The first samples are compared by the refined model only.
    return min(costs) * data.measured().size / late.measured().size

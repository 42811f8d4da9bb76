"""Whether records contradict the dynamics that were given, or need none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import shortened
from hyst.identification.families.hammerstein.joint import joint, joint_of
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.judgement.regression import chance, correlation_time
from hyst.identification.record_use.used_samples import Data

_SAMPLES = 50_000
_NOTICEABLE = 0.01  # of the squared error: less is no matter
_UNLIKELY = 1e-6  # probability that noise alone lets free dynamics explain as much
_ROUNDING = 1e-10  # of the output's power: both explain everything
_ITERATIONS = 20


def doubts_about_given(fit: Fit, data: Data) -> tuple[str, ...]:
    """Say so if dynamics that are free would leave clearly less than those that are held.

    Parameters
    ----------
    fit
        Of a hysteresis before dynamics that are held.
    data
        The records, in the units of the fit.
    """
    held, theta = joint_of(fit), fit.solution.theta
    if held.base.order == 0:
        return ()
    short = shortened(data, max(_SAMPLES // len(data.records), 1))
    free, start = joint((held.front, theta), held.base)
    problem = replace(fit, parametrization=free).problem(short)
    before = fit.problem(short).residual(theta)
    cost = float(before @ before)
    power = float(np.square(short.measured() - short.measured().mean()).sum())
    found = minimize(problem, start, _ITERATIONS)
    if found.cost > (1.0 - _NOTICEABLE) * cost or cost <= _ROUNDING * power:
        return ()
    after = problem.residual(found.theta)[: before.size]
    freedom = (before.size - start.size) / correlation_time(after)
    if chance(cost, float(after @ after), 2 * held.base.order, freedom) > _UNLIKELY:
        return ()
    rms = [float(np.sqrt(each @ each / each.size)) for each in (before, after)]
    return (
        "the records would be described better by other dynamics than those that were given: "
        f"hysteresis before them leaves {rms[0]:.4g} rms, before dynamics of the same order that "
        f"are free {rms[1]:.4g}; identify without dynamics, choose a richer hysteresis, or measure "
        "the response again at this load, with its delay",
    )

"""A fit of hysteresis and dynamics, with the dynamics that pay behind its own hysteresis."""

from __future__ import annotations

from dataclasses import replace

from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.creeping_front import joined
from hyst.identification.families.hammerstein.first_guess_of_plays import ALL, FEWER, Wanted
from hyst.identification.families.hammerstein.joint import dynamics_of
from hyst.identification.families.hammerstein.settled_dynamics import (
    ROUNDING,
    numbers_of,
    price,
    samples_worth,
    settled_dynamics,
    simpler,
)
from hyst.identification.families.option import AUTO
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

_BETTER = 0.97  # of the squared error that plays leave


def with_settled_dynamics(
    front: Fit,
    fit: Fit,
    records: tuple[Data, Data],
    wanted: Wanted,
    plays: float | None,
    max_iterations: int,
) -> Fit:
    """Fit again with other delays, orders, and without feedthrough; give the fit that pays.

    What plays made up for by a pole or a delay, the family in front may do itself.

    Parameters
    ----------
    front
        The hysteresis as a fit of its own family.
    fit
        Hysteresis and dynamics.
    records
        Of the fit, and those with the finest samples.
    wanted
        What is known of the dynamics.
    plays
        Mean squared error that plays left; None where the order is not to be looked at.
    max_iterations
        Of each further fit.
    """
    data, finest = records
    before, rows = dynamics_of(fit), data.measured().size
    steps: tuple[int, ...] = ()
    if plays is not None and wanted.state_order == AUTO:
        steps = ALL if fit.solution.cost < _BETTER * rows * plays else FEWER
    now = settled_dynamics(finest, front.operator, before, wanted.delay, steps)
    tried = {numbers_of(before): fit}
    simple = (*simpler(now.best.dynamics, wanted.delay), *simpler(before, wanted.delay))
    for each in (now.best.dynamics, *now.near, *simple):
        if numbers_of(each) not in tried:
            tried[numbers_of(each)] = _behind(front, fit, each, data, max_iterations)
    least = min(tried.values(), key=lambda each: each.solution.cost)
    errors = least.problem(data).residual(least.solution.theta)[:rows]
    worth, floor = samples_worth(errors), ROUNDING * float(data.measured().var())

    def price_of(each: Fit) -> float:
        count = each.parametrization.free_count
        return price(each.solution.cost / errors.size, count, worth, floor)

    return min(tried.values(), key=price_of)


def _behind(front: Fit, fit: Fit, dynamics: LinearDynamics, data: Data, most: int) -> Fit:
    """Fit again, from other dynamics behind the same hysteresis."""
    start = front.parametrization, front.solution.theta
    parametrization, theta = joined(start, dynamics, held=False)
    again = replace(fit, parametrization=parametrization)
    return replace(again, solution=fit.family.solve(again.problem(data), theta, most))

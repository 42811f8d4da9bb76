"""Step 5: dynamics and hysteresis to start the joint fit from.

The order of the dynamics is chosen once, with a hysteresis of middle size: the hysteresis of every
other size starts from the signal behind it that those dynamics give.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import (
    delay_of,
    of_gain_one,
    orders_to_try,
    realized,
    shortened,
    signal_behind,
)
from hyst.identification.families.hammerstein.impulse_response.markov import choose_markov
from hyst.identification.families.hammerstein.joint import dynamics_of, joint, joint_of
from hyst.identification.families.linear import Linear
from hyst.identification.fit.bounded_least_squares import Solution, minimize
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

MOST_STARTS = 3
"""Of the hysteresis."""

_WARM_UP = 8_000  # samples of each record for the trial of an order
_TRIAL_ITERATIONS = 30
_COARSELY = 1.0  # of the residual variance
_WORTH_A_STATE = 0.8  # to what share of the squared error a further state must lower it
_WORTH_A_LOOP = 0.9  # to what share of a line's the hysteresis must lower it
_ROUNDING = 1e-16  # share of the output's power: nothing is left to explain


@dataclass(frozen=True, eq=False)
class FirstDynamics:
    """Dynamics of a chosen order, and what they say of the hysteresis before them.

    Parameters
    ----------
    dynamics
        Of gain 1 at rest.
    behind
        The input, and the signal behind the hysteresis.
    trial
        The coarse fit of hysteresis and dynamics that chose them; None where plays did.
    cost
        Mean squared error that plays leave; infinity where none were tried.
    """

    dynamics: LinearDynamics
    behind: Overview
    trial: Fit | None
    cost: float = float("inf")


def first_dynamics(
    family: Family, front: Family, overview: Overview, orders: tuple[int | str, int | str]
) -> FirstDynamics:
    """Choose delay and order of the dynamics, by the error of a joint fit of middle size.

    Parameters
    ----------
    family
        Hysteresis and dynamics.
    front
        The hysteresis.
    overview
        The records.
    orders
        Last lag of the impulse response and number of states, each perhaps ``"auto"``.

    Raises
    ------
    NotIdentifiableError
        If no order can be realized, or as the steps before.
    """
    data, dt = overview.data, overview.data.records[0].dt
    markov, _ = choose_markov(data.records, orders[0])
    delay = delay_of(markov, overview.delay)
    sizes = front.sizes()
    middle = sizes[len(sizes) // 2]
    best: Fit | None = None
    least, power = np.inf, float(data.measured() @ data.measured())
    refusal: NotIdentifiableError | None = None
    for order in orders_to_try(markov, delay, dt, orders[1]):
        base = realized(markov, delay, dt, order).dynamics
        try:
            found = _trial(family, front, data, base, middle)
        except NotIdentifiableError as why:  # wrong dynamics may leave no hysteresis to see
            refusal = why
            if best is None:
                continue
            found = _solved(family, data, _front_of(best), base, middle)  # nor may amplified noise
        cost = found.solution.cost
        if best is None or cost < _WORTH_A_STATE * least:
            best, least = found, cost
            if cost <= _ROUNDING * power:
                break
        elif order > 1 and cost > _WORTH_A_STATE * least:
            break
    if best is None:
        raise refusal or NotIdentifiableError("no order can be realized; raise fir_order")
    if refusal is not None and not _beats_a_line(family, best, data):
        raise refusal
    dynamics = of_gain_one(dynamics_of(best))
    behind = Overview(signal_behind(data, dynamics), rates_matter=True)
    return FirstDynamics(dynamics, behind, best)


def _trial(family: Family, front: Family, data: Data, base: LinearDynamics, size: int) -> Fit:
    """Fit hysteresis and dynamics coarsely to the beginning of the records."""
    behind = Overview(signal_behind(data, base), rates_matter=True)
    return _solved(family, data, first_fronts(front, behind, size)[0], base, size)


def _solved(family: Family, data: Data, front: Start, base: LinearDynamics, size: int) -> Fit:
    """Fit coarsely from a hysteresis and dynamics."""
    start = joint(front, base)
    fit = Fit(family, size, start[0], Solution(start[1], np.inf, 0, ""))
    problem = fit.problem(shortened(data, _WARM_UP))
    return replace(fit, solution=minimize(problem, start[1], _TRIAL_ITERATIONS, _COARSELY))


def _front_of(trial: Fit) -> Start:
    """Give the hysteresis of a trial."""
    parametrization = joint_of(trial).front
    return parametrization, trial.solution.theta[: parametrization.size]


def _beats_a_line(family: Family, trial: Fit, data: Data) -> bool:
    """Tell whether the output shows hysteresis, and not the signal behind wrong dynamics alone."""
    line = _trial(family, Linear(), data, of_gain_one(dynamics_of(trial)), 0)
    return trial.solution.cost < _WORTH_A_LOOP * line.solution.cost


def fronts_of(
    family: Family, front: Family, first: FirstDynamics, data: Data, size: int
) -> list[Start]:
    """Fit the hysteresis to the signal behind it, or take it from the trial of the dynamics.

    Going back through the dynamics amplifies noise, where a zero is near -1 hundreds of times. A
    hysteresis may drown in it that the output shows well.

    Parameters
    ----------
    family
        Hysteresis and dynamics.
    front
        The hysteresis.
    first
        Dynamics and signal behind the hysteresis.
    data
        The records.
    size
        One of the sizes of the hysteresis.

    Raises
    ------
    NotIdentifiableError
        If that signal does not show the hysteresis, and neither does the output.
    """
    try:
        return first_fronts(front, first.behind, size)
    except NotIdentifiableError:
        trial = first.trial
        if trial is None:
            raise
        if size != trial.size:
            trial = _trial(family, front, data, joint_of(trial).base, size)
        if not _beats_a_line(family, trial, data):
            raise
        return [_front_of(trial)]


def first_fronts(front: Family, behind: Overview, size: int) -> list[Start]:
    """Fit the hysteresis to the input and the signal behind it, the best fit first.

    Parameters
    ----------
    front
        The hysteresis.
    behind
        Input and signal behind it.
    size
        One of its sizes.
    """
    found = []
    for parametrization, theta in front.starts(behind, size, MOST_STARTS):
        problem = problem_of(behind.data, parametrization, None, front.root_weights(behind.data))
        solution = front.solve(problem, theta, _TRIAL_ITERATIONS)
        found.append((parametrization, solution))
    found.sort(key=lambda each: each[1].cost)
    return [(parametrization, solution.theta) for parametrization, solution in found]

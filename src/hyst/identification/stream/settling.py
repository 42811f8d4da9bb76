"""Steps to where the gradient of a sum of squares over a file vanishes, its cost being rough.

A play that some strokes do not move keeps where its last stroke left it, which jumps from the upper
to the lower end and back as its radius passes one stroke after the other. So the cost has a tooth
for each stroke, the narrower the longer the record, and as high as before: descent ends in one of
them, or creeps along it. The derivatives here are secants across many teeth (``FitOfAll``), whose
gradient is smooth where the cost is not. So a step is good that lowers the cost, or the step that
would follow it; and where no step is, what is left of it is told.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import (
    CONVERGED,
    ITERATION_LIMIT,
    LEAST_DAMPING,
    Problem,
    Solution,
    projected_step,
)
from hyst.identification.fit.normal_equations import NormalEquations

Array = NDArray[np.float64]

TOLERANCE = 1e-2
"""Of the residual variance: no constant is then off by more than a tenth of its standard error."""

NEAR = 1.0
"""Residual variances that a step promises. Less moves no constant by more than its standard error:
where such a step is no good, teeth are all that is left."""

FIRST_REFUSED = 0.1
"""Damping after a refused step: less would hardly change it."""


@dataclass(frozen=True, eq=False)
class Settled:
    """Where the steps ended.

    Parameters
    ----------
    solution
        There.
    left
        Shape (m,), the step that was not taken any more: how far off the constants may be.
    by
        Which of the secants led there; -1 for derivatives.
    """

    solution: Solution
    left: Array
    by: int


@dataclass(frozen=True, eq=False)
class _Place:
    """Somewhere on the way: normal equations, and the whole step from there with its promise."""

    theta: Array
    normal: NormalEquations
    step: Array
    promise: float

    @property
    def variance(self) -> float:
        """Of the residual."""
        return self.normal.cost / self.normal.count


def settle(
    exact: Problem, smooth: Sequence[Problem], theta: Array, rough: tuple[int, ...], most: int
) -> Settled:
    """Go to where the gradient vanishes: by derivatives, and by secants once these mislead.

    Parameters
    ----------
    exact
        Of derivatives. Where a tooth is wide enough to hold all that noise leaves possible, or none
        is high, they lead to the right place.
    smooth
        Of secants, each wider than the one before: what misleads one may be too small for the next.
    theta
        Start; moved into the bounds.
    rough
        Which parameters make the teeth.
    most
        Steps.
    """
    here, passes = _at(exact, theta), 0
    while here.promise > TOLERANCE * here.variance and passes < most:
        there, passes = _at(exact, here.theta + here.step), passes + 1
        if not there.normal.cost < here.normal.cost:
            break
        here = there
    ended, by = here, -1
    for by, problem in enumerate(smooth):
        if ended.promise <= NEAR * ended.variance or passes == most:
            by -= 1
            break
        is_last = problem is smooth[-1]
        ended, passes = _by_secants(problem, ended.theta, rough, passes, most, is_last)
    near = ended.promise <= (TOLERANCE if passes == most else NEAR) * ended.variance
    status = CONVERGED if near else ITERATION_LIMIT
    found = Solution(ended.theta, ended.normal.cost, passes, status)
    return Settled(found, ended.step, by)


def _by_secants(
    problem: Problem,
    theta: Array,
    rough: tuple[int, ...],
    passes: int,
    most: int,
    to_the_end: bool,
) -> tuple[_Place, int]:
    """Take steps until none is good; those after the first that was not, only if asked for."""
    here, damping, growth, smooth_tried = _at(problem, theta), LEAST_DAMPING, 4.0, False
    while passes < most and here.promise > TOLERANCE * here.variance:
        passes += 1
        step, _ = projected_step(problem, here.theta, here.normal, damping)
        there = _at(problem, here.theta + step)
        if _is_better(there, here):
            here, growth, smooth_tried = there, 4.0, False
            damping = max(damping / 10.0, LEAST_DAMPING)
            continue
        length = float(step @ here.normal.matrix @ step)
        if here.promise <= NEAR * here.variance or length <= TOLERANCE * here.variance:
            break
        if not to_the_end:
            break
        damping, growth = max(damping * growth, FIRST_REFUSED), 2.0 * growth
        if not smooth_tried:
            smooth_tried = True
            other = _beside_teeth(problem, here, rough)
            here = here if other is None else other
    return here, passes


def _beside_teeth(problem: Problem, here: _Place, rough: tuple[int, ...]) -> _Place | None:
    """Go on with all parameters but those in a tooth, if that is better."""
    low, high = problem.lower.copy(), problem.upper.copy()
    low[list(rough)] = high[list(rough)] = here.theta[list(rough)]
    held = replace(problem, lower=low, upper=high)
    step, promise = projected_step(held, here.theta, here.normal, LEAST_DAMPING)
    if promise <= TOLERANCE * here.variance:
        return None
    there = _at(problem, here.theta + step)
    return there if there.normal.cost < here.normal.cost else None


def _at(problem: Problem, theta: Array) -> _Place:
    theta = problem.canonical(np.clip(theta, problem.lower, problem.upper))
    normal = problem.normal_equations(theta)
    return _Place(theta, normal, *projected_step(problem, theta, normal, LEAST_DAMPING))


def _is_better(there: _Place, here: _Place) -> bool:
    """Tell whether a step was good: the cost is known no better than its own scatter allows."""
    rise = there.normal.cost - here.normal.cost
    scatter = math.sqrt(2.0 * here.normal.count) * here.variance
    return rise < 0.0 or (rise <= scatter and there.promise < here.promise)

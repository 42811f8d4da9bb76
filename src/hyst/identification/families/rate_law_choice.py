"""Fits of rate-dependent plays with other laws of the widening, and which of them to take."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.families.rate_dependent_layout import (
    RateDependentLayout,
    RatedParametrization,
)
from hyst.identification.families.rate_law import (
    RateLaw,
    bends_to_try,
    first_constants,
)
from hyst.identification.fit.bounded_least_squares import Solution
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.stages import StagedParametrization, with_stage
from hyst.identification.judgement.regression import correlation_time
from hyst.identification.record_use.overview import Overview

Array = NDArray[np.float64]

TANGENTS = 15
"""At most; each brings the rate at which a law bends about as much closer as Newton's method."""

SAME_BEND = 1e-5
"""Change of that rate, relative, from which on the tangent is the law."""

SAME_EVIDENCE = 6.0
"""Difference of two scores of Bayes' criterion that is none: a probability of 1 to 20."""

_COMPARED_AT = np.arange(1.0, 21.0) / 20.0
"""Rates over the fastest one at which a law is brought close to another."""


def layout_of(fit: Fit) -> RateDependentLayout:
    """Give what of the plays of a fit is free.

    Parameters
    ----------
    fit
        Of rate-dependent plays, perhaps with further stages.
    """
    parametrization = fit.parametrization
    while isinstance(parametrization, StagedParametrization):
        parametrization = parametrization.base
    assert isinstance(parametrization, RatedParametrization), "the family made it"
    return parametrization.layout


def has_dynamics(fit: Fit) -> bool:
    """Tell whether the plays are the front of a model with dynamics, whose theta goes on.

    Parameters
    ----------
    fit
        Of rate-dependent plays, perhaps with further stages.
    """
    own = fit.parametrization
    return isinstance(own, RatedParametrization) and own.layout.size != own.size


def solved(fit: Fit, overview: Overview, theta: Array, max_iterations: int) -> Fit:
    """Minimise, and renew the tangent of the law until it stands where the minimum is.

    Parameters
    ----------
    fit
        Free parameters; its solution does not count.
    overview
        The records.
    theta
        Where to start.
    max_iterations
        Of each tangent.
    """
    for number in range(TANGENTS):
        problem = fit.problem(overview.data, overview.kept)
        solution = fit.family.solve(problem, theta, max_iterations)
        fit = replace(fit, solution=solution)
        layout, before = layout_of(fit), theta
        if layout.law.renewed is None:
            break
        theta = solution.theta
        bend = layout.law_places.stop - 1
        moved = abs(theta[bend] - before[bend]) > SAME_BEND * theta[bend]
        if not moved and number > 0:
            break
        renewed = layout.with_law(layout.law.renewed(theta[layout.law_places]))
        laid_out = _laid_out(fit.parametrization, renewed, overview)
        fit = replace(fit, parametrization=laid_out)
    return fit


def with_law(fit: Fit, law: RateLaw, overview: Overview, max_iterations: int) -> Fit:
    """Fit again with another law, from where a fit has ended.

    Parameters
    ----------
    fit
        A fit.
    law
        The other law.
    overview
        The records.
    max_iterations
        Of each tangent.
    """
    layout, theta = layout_of(fit), fit.solution.theta
    places = layout.law_places
    constants = _close_to(law, layout.law, theta[places])
    if law.renewed is not None:
        law = law.renewed(constants)
    start = np.concatenate([theta[: places.start], constants, theta[places.stop :]])
    unsolved = replace(
        fit,
        parametrization=_laid_out(fit.parametrization, layout.with_law(law), overview),
        solution=Solution(start, np.inf, 0, ""),
    )
    return solved(unsolved, overview, start, max_iterations)


def _laid_out(
    before: Parametrization, layout: RateDependentLayout, overview: Overview
) -> Parametrization:
    """Give the free parameters of a layout, with the stages and columns that another had."""
    if not isinstance(before, StagedParametrization):
        return replace(layout.parametrization(overview), nuisances=before.nuisances)
    base, own = _laid_out(before.base, layout, overview), slice(before.base.size, None)
    nothing = np.zeros(base.size)
    bounds = before.lower[own], before.upper[own]
    staged, _ = with_stage(base, nothing, before.stage, before.where, *bounds)
    return replace(staged, nuisances=before.nuisances)


def simplest_law(fits: Sequence[Fit], overview: Overview) -> Fit:
    """Choose among fits that differ in their law: the simplest that is not worse.

    Bayes' criterion, with as many samples as the residual of the best has independent ones.

    Parameters
    ----------
    fits
        From the simplest law to the richest.
    overview
        The records.
    """
    best = min(fits, key=lambda each: each.solution.cost)
    problem = best.problem(overview.data, overview.kept)
    error = problem.residual(best.solution.theta)
    independent = max(error.size / correlation_time(error - error.mean()), 2.0)
    floor = max(problem.negligible, np.finfo(float).tiny)

    def score(fit: Fit) -> float:
        cost = math.log(max(fit.solution.cost, floor))
        return independent * cost + layout_of(fit).law.size * math.log(independent)

    scores = [score(each) for each in fits]
    least = min(scores) + SAME_EVIDENCE
    return next(each for each, its in zip(fits, scores, strict=True) if its <= least)


def _close_to(law: RateLaw, other: RateLaw, constants: Array) -> Array:
    """Give constants with which a law is as close as can be to another one at its constants."""
    rates = law.fastest * _COMPARED_AT
    wanted = other.at(constants)(rates)
    most = max(float(wanted[-1]), 1e-6 * law.fastest * np.finfo(float).eps)
    bends = bends_to_try(law) if law.renewed is None else (0.02, 0.05, 0.12, 0.3, 0.7, 2.0, 6.0)
    tried = [
        first_constants(law, widening, bend)
        for bend, widening in product(bends, (most, 0.8 * most))
    ]

    def miss(each: Array) -> float:
        there: Callable[[Array], RateLaw] = law.renewed or (lambda _: law)
        return float(np.sum(np.square(there(each).at(each)(rates) - wanted)))

    return min(tried, key=miss)

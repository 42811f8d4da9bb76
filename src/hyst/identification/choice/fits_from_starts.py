"""Fits of one family in one size: from its starts, from the best of them, and on from a fit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hyst.identification.families.family import Family, Fit
from hyst.identification.fit.bounded_least_squares import CONVERGED, Solution
from hyst.identification.record_use.overview import Overview

SAME_COST = 0.01
"""Costs that differ by this share of the residual variance are equal."""

LEAST_ITERATIONS = 20


def best_of_starts(
    family: Family, overview: Overview, size: int, most: int, max_iterations: int = 100
) -> Fit:
    """Fit a family of a given size from several starts and keep the best.

    Parameters
    ----------
    family
        The family.
    overview
        The records.
    size
        One of its sizes.
    most
        How many starts to try.
    max_iterations
        For each start.

    Returns
    -------
    Fit
    """
    fits: list[Fit] = []
    known = overview.found(("first fit", family, size)) if most > 1 else None
    for parametrization, theta in family.starts(overview, size, most):
        if not fits and isinstance(known, Fit) and _serves(known, max_iterations):
            fits.append(known)
            continue
        unsolved = Fit(family, size, parametrization, Solution(theta, np.inf, 0, ""))
        problem = unsolved.problem(overview.data, overview.kept)
        solution = family.solve(problem, theta, max_iterations)
        fits.append(replace(unsolved, solution=solution))
    return min(fits, key=lambda each: each.solution.cost)


def _serves(known: Fit, max_iterations: int) -> bool:
    """Tell whether a fit is what one with other steps at most would come to."""
    ended = known.solution
    return ended.status == CONVERGED and ended.iterations <= max_iterations


def first_fit(family: Family, overview: Overview, size: int) -> Fit:
    """Fit a family of a given size from its best guess, once for all who ask.

    Parameters
    ----------
    family
        The family.
    overview
        The records.
    size
        One of its sizes.
    """
    return overview.once(
        ("first fit", family, size), lambda: best_of_starts(family, overview, size, most=1)
    )


def settled(fit: Fit, overview: Overview, max_iterations: int) -> Fit:
    """Go on from a fit that did not converge, and take it for converged if that gains nothing.

    At a kink the iteration may go back and forth for ever within a fraction of a standard error.

    Parameters
    ----------
    fit
        A fit.
    overview
        Its records.
    max_iterations
        At most.

    Returns
    -------
    Fit
    """
    if fit.solution.status == CONVERGED:
        return fit
    problem = fit.problem(overview.data, overview.kept)
    again = fit.family.solve(problem, fit.solution.theta, max(max_iterations, LEAST_ITERATIONS))
    samples = overview.data.measured().size
    same = fit.solution.cost - again.cost <= SAME_COST * again.cost / samples
    solution = replace(again, status=CONVERGED) if same else fit.solution
    return replace(fit, solution=solution)

"""Few samples, on which a family shows whether it comes near others at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Family, Fit
from hyst.identification.fit.bounded_least_squares import CONVERGED, Problem, Solution
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.thinning import thinned

Array = NDArray[np.float64]

LOOK_SAMPLES = 2000
"""About so many."""

LEG, MOST_LEGS = 10, 10
"""Iterations after which a fit is asked how far it still may go, and how often."""

REACH = 2.0
"""Times what the last leg gained: what a fit is taken to gain yet. A gain that falls by a third
from leg to leg gains so much for ever."""


def for_a_look(overview: Overview) -> Overview:
    """Give an overview of few samples, once for all who ask.

    Parameters
    ----------
    overview
        What families are compared on; given as it is where rates matter, or it has no more.
    """
    if overview.rates_matter:
        return overview

    def found() -> Overview:
        data = thinned(overview.data, LOOK_SAMPLES)
        return overview if data is overview.data else Overview(data, overview.delay)

    return overview.once("few samples", found)


def look_at(family: Family, fewer: Overview, size: int, most: float) -> Fit:
    """Fit a family from its best guess, as long as it may still come near.

    Parameters
    ----------
    family
        The family.
    fewer
        Few samples.
    size
        One of its sizes.
    most
        Mean square that is near; a fit that crawls far above it is given as it is.

    Returns
    -------
    Fit
    """

    def found() -> Fit:
        fits = list[Fit]()
        for parametrization, theta in family.starts(fewer, size, 1):
            unsolved = Fit(family, size, parametrization, Solution(theta, np.inf, 0, ""))
            problem = unsolved.problem(fewer.data, fewer.kept)
            solution = _in_legs(family, problem, theta, most)
            fits.append(replace(unsolved, solution=solution))
        return min(fits, key=lambda each: each.solution.cost)

    return fewer.once(("look", family, size, most), found)


def _in_legs(family: Family, problem: Problem, theta: Array, most: float) -> Solution:
    solution = family.solve(problem, theta, LEG)
    enough = most * problem.residual(solution.theta).size
    for _ in range(MOST_LEGS - 1):
        if solution.status == CONVERGED:
            break
        before, solution = solution, family.solve(problem, solution.theta, LEG)
        if solution.cost - REACH * (before.cost - solution.cost) > enough:
            break
    return solution

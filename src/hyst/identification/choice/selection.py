"""Choose family and size."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hyst.errors import NotIdentifiableError
from hyst.identification.choice.cross_validation import cross_validate, fewest_left
from hyst.identification.families.family import Family, Fit
from hyst.identification.fit.bounded_least_squares import CONVERGED, Solution
from hyst.identification.record_use.overview import Overview
from hyst.identification.result.identified import Candidate

SMALLEST_GAIN = 1e-3
"""A larger model of the same family must lower the score by this share to be worth going on."""

ROUNDING = 1e-6
"""Scores below this share of the output range are equal: no sensor tells them apart."""

SAME_COST = 0.01
"""Costs that differ by this share of the residual variance are equal."""

LEAST_ITERATIONS = 20


@dataclass(frozen=True, eq=False)
class Contender:
    """A family, the records it is fitted to, and one of its sizes with its score.

    Parameters
    ----------
    family, overview
        The family and its records.
    candidate
        Size and score.
    """

    family: Family
    overview: Overview
    candidate: Candidate


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
    fits = []
    for parametrization, theta in family.starts(overview, size, most):
        unsolved = Fit(family, size, parametrization, Solution(theta, np.inf, 0, ""))
        problem = unsolved.problem(overview.data)
        solution = family.solve(problem, theta, max_iterations)
        fits.append(replace(unsolved, solution=solution))
    return min(fits, key=lambda each: each.solution.cost)


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
    problem = fit.problem(overview.data)
    again = fit.family.solve(problem, fit.solution.theta, max(max_iterations, LEAST_ITERATIONS))
    samples = overview.data.measured().size
    same = fit.solution.cost - again.cost <= SAME_COST * again.cost / samples
    solution = replace(again, status=CONVERGED) if same else fit.solution
    return replace(fit, solution=solution)


def compare(
    families: Sequence[tuple[Family, Overview]], progress: Callable[[str], None]
) -> tuple[tuple[Contender, ...], tuple[str, ...]]:
    """Score families and sizes by blocked cross-validation.

    Sizes of a family are tried upwards until two in a row have not lowered the score, or until
    there are as many parameters as samples to fit them to.

    Parameters
    ----------
    families
        Each with its records.
    progress
        Told what is being fitted.

    Returns
    -------
    tuple of Contender
        From the simplest family to the richest, none of them chosen yet.
    tuple of str
        Sentences about families that cannot be fitted.

    Raises
    ------
    NotIdentifiableError
        If there are too few samples to judge any, or no family can be fitted.
    """
    contenders: list[Contender] = []
    refusals: dict[str, NotIdentifiableError] = {}
    for family, overview in families:
        try:
            contenders += _grow(family, overview, progress)
        except NotIdentifiableError as refusal:  # one family less to compare
            refusals[family.name] = refusal
    if not contenders and refusals:
        raise next(iter(refusals.values()))
    if not contenders:
        samples = families[0][1].data.measured().size
        raise NotIdentifiableError(
            f"{samples} samples can be used, too few to choose the number of plays by "
            "cross-validation; give a longer record or the number of plays"
        )
    return tuple(contenders), not_compared(refusals)


def not_compared(refusals: Mapping[str, NotIdentifiableError]) -> tuple[str, ...]:
    """Say which families are left out of a comparison, and why."""
    return tuple(f"{name} is not compared: {why}" for name, why in refusals.items())


def simplest_good(contenders: Sequence[Contender], output_range: float) -> Contender:
    """Give the simplest contender within one standard error of the best.

    Simple means few free parameters; between equals the earlier is taken, so families must come
    from the simplest to the richest.

    Parameters
    ----------
    contenders
        At least one.
    output_range
        Of the records, output units.

    Returns
    -------
    Contender

    Notes
    -----
    Breiman et al., Classification and Regression Trees (1984), sec. 3.4.3: the one standard error
    rule.
    """
    best = min((each.candidate for each in contenders), key=lambda each: each.score)
    limit = max(best.score + best.standard_error, ROUNDING * output_range)
    good = [each for each in contenders if each.candidate.score <= limit]
    return min(good, key=lambda each: each.candidate.parameters)


def _grow(family: Family, overview: Overview, progress: Callable[[str], None]) -> list[Contender]:
    found: list[Contender] = []
    best, idle = float("inf"), 0
    for size in family.sizes():
        progress(family.named_size(size))
        fit = best_of_starts(family, overview, size, most=1)
        if fit.parametrization.free_count >= fewest_left(overview.data.measured().size):
            break
        score = cross_validate(overview.data, fit)
        candidate = Candidate(
            family.name,
            size,
            fit.parametrization.free_count,
            score.rms,
            score.standard_error,
            chosen=False,
        )
        found.append(Contender(family, overview, candidate))
        idle = 0 if score.rms < best * (1.0 - SMALLEST_GAIN) else idle + 1
        best = min(best, score.rms)
        if idle == 2:
            break
    return found

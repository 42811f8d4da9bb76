"""Which plays the samples show: those without which no other plays fit as well."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.online.joint.bands.intervals import covariance_of_minimum
from hyst.online.joint.bands.refit import Minimum, Problem, minimum_from

Array = NDArray[np.float64]

# A play that is not there finds, of all radii, the one where noise looks most like it: that gains
# more than the 4 of two standard errors.
_SHOWN = 16.0
# Of a weight over its standard error; leaving such a play out is not tried.
_CERTAIN = 30.0


def fits_of_fewer(problem: Problem, best: Minimum) -> list[Minimum]:
    """Leave out plays, one more each time, as long as the others fit nearly as well.

    Parameters
    ----------
    problem, best
        What was fitted, and where.

    Returns
    -------
    list of Minimum
        With one play less, with two less, ...; those that are left out are the last of them, with
        weight 0. Empty where the samples show all plays, or some are held.
    """
    n = problem.parts.pi.p.size
    if not problem.free[1 : 2 * n + 1].all():
        return []
    found: list[Minimum] = []
    now = best
    for left in range(n, 0, -1):
        tried = _without_one(problem, now, left, best.chi_square)
        if tried is None or tried.chi_square > best.chi_square + _SHOWN:
            break
        now = tried
        found.append(now)
    return found


def _without_one(problem: Problem, minimum: Minimum, left: int, best: float) -> Minimum | None:
    """Give the best fit with one of the first ``left`` plays less; None if all of them show."""
    n = problem.parts.pi.p.size
    limit = problem.limit.copy()
    limit[left : n + 1] = limit[n + left : 2 * n + 1] = 0.0
    fewer = replace(problem, limit=limit)
    deviation = np.sqrt(np.diag(covariance_of_minimum(problem, minimum)))
    # Beyond all others, where it is in the way of none.
    away = max(float(minimum.theta[2 * n]), 0.5 * problem.samples.swing)
    found = []
    for i in range(left):
        if abs(minimum.theta[1 + i]) > _CERTAIN * deviation[1 + i]:
            continue
        start = minimum.theta.copy()
        start[1 + i : left], start[left] = minimum.theta[2 + i : left + 1], 0.0
        start[n + 1 + i : n + left] = minimum.theta[n + 2 + i : n + left + 1]
        start[n + left :][: n - left + 1] = away
        found.append(minimum_from(fewer, start, left, hopeless=best + 10.0 * _SHOWN))
    return min(found, key=lambda each: each.chi_square, default=None)

"""The best inverse with fewer plays, in the sense of the error bound."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive, whole_number
from hyst.compensation.error_of_inverse.slope_steps import SlopeSteps
from hyst.models import PrandtlIshlinskii
from hyst.models.mapped_plays import MappedPlays
from hyst.operators import Composition, Operator

Array = NDArray[np.float64]


def reduce_inverse(model: Operator, plays: int, y_max: float) -> Operator:
    """Give the inverse with at most that many plays whose error bound is least.

    Minimises ``integral_0^R |phi_hat - phi| ds`` over all step functions phi_hat with ``plays``
    steps, thresholds anywhere: for a PI model the least worst case over all references within
    ``+-y_max`` (the bound is attained, see ``error_bound``); maps before or after the plays stay
    exact.

    Parameters
    ----------
    model
        As in ``error_bound``.
    plays
        Largest number of plays, >= 0.
    y_max
        Largest ``|y_ref|``, positive, output units.

    Returns
    -------
    Operator
        A ``PrandtlIshlinskii`` model, between the inverse maps where there are maps. Plays that
        cannot move within ``+-y_max`` are left out.

    Raises
    ------
    InputError
        If ``plays`` is not an integer >= 0, or as in ``error_bound``.
    NotInvertibleError
        If the model has no exact inverse.

    Notes
    -----
    The optimum is global. With the levels on both sides held, the integral is linear in a threshold
    as long as it stays within one piece of phi, so an optimum has its thresholds at thresholds of
    phi. On each run of pieces the best level is the weighted median of phi, one of phi's own
    (positive) values, so the result is itself monotone. Which runs is found by dynamic programming.

    Examples
    --------
    >>> model = PrandtlIshlinskii([0.2, 0.3, 0.5], [1.0, 2.0, 3.0], p0=0.5)
    >>> reduced = reduce_inverse(model, 1, y_max=4.0)
    >>> reduced.r.round(9), round(reduced.p0, 3), reduced.p.round(3)
    (array([1.2]), 1.429, array([-0.762]))
    """
    kept = whole_number(plays, "plays", 0)
    reach = as_positive(y_max, "y_max", "the largest |y_ref|")
    exact = MappedPlays.of(model, "the model").inverse()
    edges, levels = SlopeSteps.of(exact.plays).pieces(exact.before.largest_value(reach))
    starts, best = _fewer_steps(np.diff(edges), levels, kept + 1)
    keep = np.append(True, np.diff(best) != 0.0)
    starts, best = starts[keep], best[keep]
    reduced = PrandtlIshlinskii(np.diff(best), edges[starts[1:]], float(best[0]))
    about = model.inverse().description  # of which the verdict is not lost with the plays
    if not exact.before.stages and not exact.after.stages:
        return reduced.with_description(about)
    stages = [*exact.before.stages, reduced, *exact.after.stages]
    return Composition(stages).with_description(about)


def _fewer_steps(widths: Array, levels: Array, count: int) -> tuple[NDArray[np.intp], Array]:
    """First piece and level of each run, at most ``count`` runs, least sum |difference| width."""
    n = levels.size
    cost, median = _costs_of_runs(widths, levels)
    # best[j] is the least cost of the first j pieces with the runs so far, cut[k][j] its last run.
    best, cuts = np.append(0.0, np.full(n, np.inf)), []
    for _ in range(min(count, n)):
        total = best[:-1, None] + cost
        cuts.append(np.concatenate([[0], total.argmin(axis=0)]))
        best = np.append(np.inf, total.min(axis=0))
    starts, end = [], n
    for cut in reversed(cuts):
        starts.append(int(cut[end]))
        end = starts[-1]
    first = np.array(starts[::-1], dtype=np.intp)
    last = np.append(first[1:], n) - 1
    return first, median[first, last]


def _costs_of_runs(widths: Array, levels: Array) -> tuple[Array, Array]:
    """Cost and weighted median of each run of pieces i .. j, infinite where j < i."""
    n = levels.size
    steps = np.diff(levels)
    if (steps <= 0.0).all() or (steps >= 0.0).all():
        return _costs_of_monotone_runs(widths, levels)
    cost, median = np.full((n, n), np.inf), np.zeros((n, n))
    for i in range(n):
        for j in range(i, n):
            order = i + np.argsort(levels[i : j + 1], kind="stable")
            reached = np.cumsum(widths[order])
            middle = levels[order[int(np.searchsorted(reached, 0.5 * reached[-1]))]]
            median[i, j] = middle
            cost[i, j] = np.abs(levels[i : j + 1] - middle) @ widths[i : j + 1]
    return cost, median


def _costs_of_monotone_runs(widths: Array, levels: Array) -> tuple[Array, Array]:
    """Give the same where levels rise or fall throughout: in a known order sums will do."""
    n = levels.size
    edges = np.append(0.0, np.cumsum(widths))
    areas = np.append(0.0, np.cumsum(widths * levels))
    i, j = np.triu_indices(n)
    middle = np.searchsorted(edges, 0.5 * (edges[i] + edges[j + 1]), side="right") - 1
    middle = np.clip(middle, i, j)
    below = areas[middle] - areas[i] - levels[middle] * (edges[middle] - edges[i])
    above = areas[j + 1] - areas[middle] - levels[middle] * (edges[j + 1] - edges[middle])
    cost, median = np.full((n, n), np.inf), np.zeros((n, n))
    cost[i, j], median[i, j] = np.abs(below - above), levels[middle]
    return cost, median

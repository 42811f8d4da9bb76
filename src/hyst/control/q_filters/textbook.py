"""The search for the time constant of a continuous Q-filter, by the Hamiltonian."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hyst.control.infinity_norm import hinf_norm
from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.loops import filtered_inverse, weighted_stack
from hyst.control.q_filters.problem import QFilterProblem
from hyst.control.q_filters.rejection import robust_performance_of
from hyst.control.q_filters.responses import fixed_responses, grid_of
from hyst.control.q_filters.search import TimeConstantSearch, cost_with_noise

Array = NDArray[np.float64]

_BEYOND = 30.0  # faster and slower than all poles and zeros of the problem


def time_constant_search(
    problem: QFilterProblem,
    family: Callable[[float], QFilter],
    most_noise: float | None,
    robust: bool = False,
) -> TimeConstantSearch:
    """Set up the search for the tau of least stacked norm.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    family
        From tau to the filter.
    most_noise
        Bound on the norm of Q/Pn; None if it may be any.
    robust
        Minimize |Wp (1 - Q)| + |Wu T| instead.
    """
    fixed = fixed_responses(problem, grid_of(problem))
    size = np.abs(problem.features)

    def on_grid(taus: Array) -> Array:
        Q = np.array([family(float(tau)).response(fixed.s) for tau in taus])
        seen = fixed.with_filter(Q)
        rows = seen.robust_performance if robust else seen.stacked
        pairs = zip(rows.max(axis=1), seen.Q_over_plant.max(axis=1), strict=True)
        return np.array([cost_with_noise(a, b, most_noise) for a, b in pairs])

    def exact(tau: float) -> float:
        Q = family(tau)
        if robust:
            norm = robust_performance_of(problem, Q, grid_of(problem, Q)).value
        else:
            norm = hinf_norm(weighted_stack(problem, Q.system))[0]
        if most_noise is None:
            return norm
        return cost_with_noise(norm, hinf_norm(filtered_inverse(problem, Q))[0], most_noise)

    fastest, slowest = 1.0 / (float(size.max()) * _BEYOND), _BEYOND / float(size.min())
    return TimeConstantSearch(on_grid, exact, fastest, slowest)

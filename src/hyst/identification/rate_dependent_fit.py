"""Fit rate-dependent plays to records of several frequencies at once.

For given radii and rate coefficient the weights solve a non-negative linear least squares problem,
so first guesses come from a coarse grid over those two alone; the best of them are refined together
with the weights by Levenberg-Marquardt with the analytic Jacobian.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.identification.bounded_least_squares import CONVERGED, Problem, Solution, minimize
from hyst.identification.data import Data
from hyst.identification.fitting import model_jacobian, model_output
from hyst.identification.rate_dependent_layout import EVEN, FREE, GIVEN, Layout
from hyst.models import RateDependentPrandtlIshlinskii

Array = NDArray[np.float64]

_SPANS = (0.3, 0.5, 0.7, 0.9)
"""Largest radius of first guesses, over the largest the records can show."""

_WIDENINGS = (0.0, 0.1, 0.25, 0.5, 0.9)
"""Widening at the fastest sample of first guesses, over the largest radius."""

_STARTS = 3

_LEAST_ITERATIONS = 20

_SAME_COST = 0.01
"""Costs that differ by this share of the residual variance are equal."""


@dataclass(frozen=True, eq=False)
class RateDependentFit:
    """A layout and where the iteration ended.

    Parameters
    ----------
    layout, solution
        Free parameters and their best values.
    """

    layout: Layout
    solution: Solution


def root_weights(data: Data, record_weights: Array) -> Array:
    """Give the square root of every sample's weight.

    Parameters
    ----------
    data
        The records.
    record_weights
        Shape (records,), A_p of S4 eq. 44.

    Returns
    -------
    numpy.ndarray
        Shape (samples used,).
    """
    lengths = [window.stop - window.start for window in data.windows()]
    return np.repeat(np.sqrt(record_weights), lengths)


def fit_layout(
    data: Data,
    layout: Layout,
    record_weights: Array,
    max_iterations: int,
    start: Array | None = None,
) -> RateDependentFit:
    """Fit one layout.

    Parameters
    ----------
    data
        The records.
    layout
        What is free.
    record_weights
        Shape (records,).
    max_iterations
        For each start.
    start
        Theta to start from; the best of a grid if left out.

    Returns
    -------
    RateDependentFit
    """
    root = root_weights(data, record_weights)
    problem = _problem(data, layout, root)
    starts = [start] if start is not None else _first_guesses(data, layout, root)
    solutions = [minimize(problem, theta, max_iterations) for theta in starts]
    best = min(solutions, key=lambda each: each.cost)
    if best.status != CONVERGED:
        # At a kink the iteration may go back and forth for ever within a fraction of a standard
        # error; it has converged if that many iterations again gain nothing.
        again = minimize(problem, best.theta, max(max_iterations, _LEAST_ITERATIONS))
        same = best.cost - again.cost <= _SAME_COST * again.cost / root.size
        best = replace(again, status=CONVERGED) if same else best
    return RateDependentFit(layout, best)


def _problem(data: Data, layout: Layout, root: Array) -> Problem:
    target = data.measured()

    def residual(theta: Array) -> Array:
        return root * (model_output(data, layout.operator(theta)) - target)

    def linearize(theta: Array) -> tuple[Array, Array]:
        jacobian = model_jacobian(data, layout.operator(theta)) @ layout.transform
        return residual(theta), root[:, None] * jacobian

    negligible = float(target.size * (1e-12 * np.ptp(target)) ** 2)
    bounds = (layout.lower, layout.upper)
    return Problem(linearize, residual, *bounds, layout.canonical, negligible=negligible)


def _first_guesses(data: Data, layout: Layout, root: Array) -> list[Array]:
    """Theta of the best points of a grid over radii and beta, weights by linear least squares."""
    steps = max(float(np.abs(np.diff(record.u)).max()) for record in data.records)
    fastest = steps / layout.dt
    widenings = _WIDENINGS if layout.has_rate else (0.0,)
    guesses = []
    for radii in _radius_guesses(layout):
        for widening in widenings:
            beta = widening * layout.largest_radius / fastest
            guesses.append(_with_weights(data, layout, root, radii, beta))
    guesses.sort(key=lambda each: each[0])
    return [theta for _, theta in guesses[:_STARTS]]


def _radius_guesses(layout: Layout) -> list[Array]:
    n = layout.plays
    if layout.spacing == GIVEN:
        return [layout.radii]
    if n == 0:
        return [np.empty(0)]
    even = [share * layout.largest_radius * np.arange(1, n + 1) / n for share in _SPANS]
    if layout.spacing == EVEN:
        return even
    return even + [each**2 / each[-1] for each in even if n > 1]


def _with_weights(
    data: Data, layout: Layout, root: Array, radii: Array, beta: float
) -> tuple[float, Array]:
    """Residual norm and theta for given radii and beta."""
    n = layout.plays
    bank = RateDependentPrandtlIshlinskii(np.zeros(n), radii, beta, layout.dt)
    # The derivative by p0 and p is the input and the play outputs.
    columns = layout.sign * model_jacobian(data, bank)[:, : n + 1] * root[:, None]
    target = root * data.measured()
    matrix = np.column_stack([columns, root, -root])
    weights, miss = scipy.optimize.nnls(matrix, target)
    # A weight that starts on its bound would give its radius no derivative.
    slopes = np.maximum(weights[: n + 1], 0.01 * layout.mean_slope)
    free = radii if layout.spacing == FREE else radii[: layout.radius_count]
    return float(miss), layout.theta(slopes, free, beta, float(weights[-2] - weights[-1]))

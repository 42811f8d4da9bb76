"""A butterfly with relays inside: theta = (weights of the cells of a grid, c), under a prior.

Plays behind an envelope give a first state z. Relays are fitted to it, which is a linear problem,
and then to the output, together with the coefficients. The weights add up to 1, so that z goes from
-1 to 1: a gauge. They are never negative, and their density is smooth where the records leave it
open.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.butterfly_layout import parametrize_butterfly
from hyst.identification.families.butterfly_starts import best_guesses, coefficients_of
from hyst.identification.families.preisach.cells import Cells, even_cells
from hyst.identification.families.preisach.smoothness import effective_count
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.bounded_quadratic import least_within
from hyst.identification.fit.parametrization import Parametrization, selection
from hyst.identification.fit.problem import model_jacobian, model_output, problem_of
from hyst.identification.record_use.overview import Overview
from hyst.models import Butterfly, Preisach
from hyst.operators import Operator

Array = NDArray[np.float64]

STRENGTH = 3e-4
"""Of the prior of smoothness: a third and three times of it predict another drive as well."""

_FIRST_STRENGTH = 1e-2
_PLAYS, _KNOTS, _ITERATIONS = 4, 14, 40
"""Of the plays that give the first state."""


@dataclass(frozen=True, eq=False)
class RelayParametrization(Parametrization):
    """A parametrization that knows its grid.

    Parameters
    ----------
    cells
        The grid.
    effective
        How many combinations of theta the records determine.
    """

    cells: Cells = None  # type: ignore[assignment]  # the fields before it have defaults
    effective: int = 1

    @property
    def free_count(self) -> int:
        """Number of combinations of the parameters that the records determine."""
        return self.effective


def relay_start(overview: Overview, levels: int, degree: int) -> tuple[RelayParametrization, Array]:
    """Give relays that make what plays behind an envelope have made, and the best map of them.

    Parameters
    ----------
    overview
        The records.
    levels
        Cells of the grid along a side.
    degree
        Of the map.

    Returns
    -------
    RelayParametrization
    theta : numpy.ndarray
    """
    records = overview.data.records
    low, high = min(float(r.u.min()) for r in records), max(float(r.u.max()) for r in records)
    cells = even_cells(low, high, levels)
    relays = _relays(overview, cells, _first_state(overview, degree))
    c, _ = coefficients_of(overview, relays, degree)
    return _parametrized(overview, cells, Butterfly(relays, c))


def turns_of_cells(overview: Overview, model: Butterfly) -> Array:
    """Give what every cell adds to the state at every sample, -1 to 1, shape (samples, cells).

    Parameters
    ----------
    overview
        The records.
    model
        With relays inside.
    """
    return model_jacobian(overview.data, model.hysteresis)[:, 1:]


def _first_state(overview: Overview, degree: int) -> Array:
    """Give the state of the best plays, over the samples used."""
    found: list[tuple[float, int, Operator]] = []
    for guess in best_guesses(overview, _PLAYS, _KNOTS, degree, 2):
        parametrization, theta = parametrize_butterfly(guess)
        problem = problem_of(overview.data, parametrization, overview.kept)
        solution = minimize(problem, theta, _ITERATIONS)
        found.append((solution.cost, len(found), parametrization.operator(solution.theta)))
    model = min(found, key=lambda each: each[:2])[2]
    assert isinstance(model, Butterfly), "the layout made it"
    return model_output(overview.data, model.hysteresis)


def _relays(overview: Overview, cells: Cells, z: Array) -> Preisach:
    """Give relays whose state is closest to another one but for an offset."""
    grid = np.zeros((cells.levels, cells.levels))
    grid[cells.places] = cells.areas()
    columns = model_jacobian(overview.data, Preisach(grid, cells.thresholds))[:, 1:]
    columns = np.column_stack([columns, np.ones(z.size)])
    rows = np.zeros((len(cells.differences()), cells.count + 1))
    strength = _FIRST_STRENGTH * float(np.linalg.norm(z - z.mean()))
    rows[:, :-1] = strength * cells.differences()
    lower = np.zeros(cells.count + 1)
    lower[-1] = -np.inf
    upper = np.full(lower.size, np.inf)
    normal = columns.T @ columns + rows.T @ rows
    weights = least_within(normal, columns.T @ z, lower, upper, np.ones(lower.size))[:-1]
    grid[cells.places] = weights / float(weights.sum())
    return Preisach(grid, cells.thresholds)


def _parametrized(
    overview: Overview, cells: Cells, template: Butterfly
) -> tuple[RelayParametrization, Array]:
    constants = template.parameters().values
    size = constants.size - 1  # all but p0 of the relays
    transform, fixed = selection(constants.size, list(range(1, constants.size))), constants.copy()
    fixed[1:] = 0.0
    lower, upper = np.full(size, -np.inf), np.full(size, np.inf)
    lower[: cells.count] = 0.0
    prior = np.zeros((len(cells.differences()), size))
    prior[:, : cells.count] = STRENGTH * cells.differences()
    sums = np.zeros((1, size))
    sums[0, : cells.count] = 1.0
    theta = constants[1:].copy()
    parametrization = RelayParametrization(
        template,
        transform,
        fixed,
        lower,
        upper,
        gauges=partial(_sum_of_cells, sums),
        gauge_count=1,
        prior=prior,
        cells=cells,
        effective=_effective(overview, template, prior, theta > lower),
    )
    return parametrization, theta


def _sum_of_cells(sums: Array, theta: Array) -> tuple[Array, Array]:
    return sums @ theta - 1.0, sums


def _effective(overview: Overview, model: Butterfly, prior: Array, free: NDArray[np.bool_]) -> int:
    """Give how many combinations of weights and coefficients the records determine."""
    by_theta = model_jacobian(overview.data, model)[:, 1:]
    y = overview.data.measured()
    held = float(np.linalg.norm(y - y.mean())) * prior
    return max(1, round(effective_count(by_theta.T @ by_theta, held.T @ held, free)))

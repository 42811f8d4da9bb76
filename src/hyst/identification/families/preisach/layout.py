"""The free parameters of a Preisach model: what is where in theta, and what the prior holds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.identification.families.preisach.cells import Cells
from hyst.identification.families.preisach.smoothness import LinearFit
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization
from hyst.identification.record_use.overview import Overview
from hyst.operators import Affine, Composition, Operator
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CellParametrization(Parametrization):
    """theta = (p0, weights row by row, offset, further constants), weights under a prior.

    Parameters
    ----------
    effective
        How many combinations of them the records determine.
    """

    effective: int = 1

    @property
    def free_count(self) -> int:
        """Number of combinations of the parameters that the records determine."""
        return self.effective


def relays_of(operator: Operator) -> models.Preisach:
    """Give the Preisach model inside an operator.

    Parameters
    ----------
    operator
        As the family made it.
    """
    return next(each for each in leaves_of(operator) if isinstance(each, models.Preisach))


def cells_of(operator: Operator) -> Cells:
    """Give the cells of the Preisach model inside an operator.

    Parameters
    ----------
    operator
        As the family made it.
    """
    return Cells(np.asarray(relays_of(operator).thresholds))


def weights_of(operator: Operator) -> Array:
    """Give the weights of the cells, row by row.

    Parameters
    ----------
    operator
        As the family made it.
    """
    return np.asarray(relays_of(operator).parameters().values[1:])


def parametrized(
    overview: Overview, cells: Cells, front: tuple[Operator, ...] = ()
) -> CellParametrization:
    """Lay out theta of a Preisach model on a grid, without a prior.

    Parameters
    ----------
    overview
        The records.
    cells
        The grid, in their units.
    front
        What comes before the relays; its constants stay as they are.
    """
    even = np.zeros((cells.levels, cells.levels))
    even[cells.places] = overview.output_range * cells.areas()
    relays = models.Preisach(even, cells.thresholds)
    template = Composition((*front, relays, Affine(overview.sign, 0.0)))
    before = sum(len(each.parameters()) for each in front)
    count = 1 + cells.count
    places = [*range(before, before + count), before + count + 1]
    fixed = template.parameters().values.copy()
    fixed[places] = 0.0
    transform = np.zeros((fixed.size, len(places)))
    transform[places, range(len(places))] = 1.0
    lower = np.zeros(len(places))
    lower[0], lower[-1] = SMALLEST_SLOPE * overview.mean_slope, -np.inf
    return CellParametrization(
        template, transform, fixed, lower, np.full(len(places), np.inf), is_linear=True
    )


def with_prior(
    parametrization: CellParametrization, rows: Array, strength: float, effective: float
) -> CellParametrization:
    """Put the weights under a prior.

    Parameters
    ----------
    parametrization
        Without one.
    rows
        Shape (q, m), of ``prior_rows``.
    strength
        What they are multiplied by; without effect if 0.
    effective
        How many combinations the records determine under it.
    """
    prior = strength * rows if strength > 0.0 else None
    return replace(parametrization, prior=prior, effective=max(1, round(effective)))


def prior_rows(cells: Cells, output_range: float, count: int) -> Array:
    """Give the slopes of the density that theta makes, where a mean one is 1, shape (q, m).

    Parameters
    ----------
    cells
        The grid.
    output_range
        Of the records: the mass of a mean density.
    count
        Number of free parameters.
    """
    slopes = cells.differences() / (0.5 * output_range)
    rows = np.zeros((len(slopes), count))
    rows[:, 1 : 1 + cells.count] = slopes
    return rows


def linear_fit(overview: Overview, parametrization: CellParametrization, cells: Cells) -> LinearFit:
    """Give what the output is made of, at every sample used.

    Parameters
    ----------
    overview
        The records.
    parametrization
        Without a prior.
    cells
        The grid.
    """
    evaluation = Evaluation(overview.data, parametrization)
    columns = evaluation.jacobian(start_of(parametrization))
    return LinearFit(
        columns,
        overview.data.measured(),
        parametrization.lower,
        parametrization.upper,
        prior_rows(cells, overview.output_range, parametrization.size),
    )


def start_of(parametrization: CellParametrization) -> Array:
    """Give a theta within its bounds: no mass yet, and the least linear part."""
    return np.maximum(parametrization.lower, 0.0)

"""How fine the grid of a Preisach model is, and how smooth its density."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.choice.blocks import blocks_of
from hyst.identification.families.preisach.cells import Cells
from hyst.identification.families.preisach.coverage import crossed, require_crossed
from hyst.identification.families.preisach.layout import (
    CellParametrization,
    linear_fit,
    start_of,
    with_prior,
)
from hyst.identification.families.preisach.smoothness import (
    borne_strength,
    chosen_strength,
    effective_count,
)
from hyst.identification.record_use.overview import Overview

Array = NDArray[np.float64]

LEVELS, ADAPTED_LEVELS = 24, 32
"""What ``"auto"`` takes, and at most where it adapts the grid."""

FEWEST_LEVELS, MOST_LEVELS = 4, 48
SAMPLES_A_LEVEL = 8

MISFIT, SURE = 0.04, 3.0
"""Correlation of neighbouring residuals from which on an adapted grid is tried, at least so many of
its standard deviations."""

WORTH_IT = 0.97
"""Residual of an adapted grid, over that of the even one, up to which it is taken."""

ROUNDING = 1e-4
"""Of the output's range: a residual so small is none to improve."""

NOTHING = 1e-6
"""The same, up to which the strength of a prior is not doubted."""


@dataclass(frozen=True, eq=False)
class GridFit:
    """Weights on a grid under a prior.

    Parameters
    ----------
    parametrization, theta
        Free parameters and their best values.
    strength
        Of the prior.
    rms
        Of the residual, output units.
    correlation
        Of neighbouring residuals, over what noise alone may show.
    """

    parametrization: CellParametrization
    theta: Array
    strength: float
    rms: float
    correlation: float


def levels_for(samples: int, most: int = LEVELS) -> int:
    """Give the levels that a number of samples is enough for.

    Parameters
    ----------
    samples
        Of all records.
    most
        Levels.
    """
    return max(FEWEST_LEVELS, min(most, samples // SAMPLES_A_LEVEL))


def least_samples(levels: int) -> int:
    """Give how many samples a grid needs at least: more than one loop has marginal masses.

    Parameters
    ----------
    levels
        Number of cells along a side.
    """
    return 2 * levels + 2


def fitted_grid(
    overview: Overview,
    cells: Cells,
    parametrization: CellParametrization,
    smoothness: float | None,
) -> GridFit:
    """Fit the weights of a grid, the strength of the prior as given or chosen.

    Parameters
    ----------
    overview
        The records.
    cells, parametrization
        The grid, and its free parameters without a prior.
    smoothness
        Strength; None chooses it on left-out blocks.

    Raises
    ------
    NotIdentifiableError
        If the records cross less than half of the grid.
    """
    fit = linear_fit(overview, parametrization, cells)
    of_cells = fit.columns[:, 1 : 1 + cells.count]
    require_crossed(cells, crossed(of_cells, overview.data.lengths()))
    kept = overview.kept
    rows = np.ones(fit.y.size, dtype=bool) if kept is None else kept
    if smoothness is None:
        blocks = overview.once("blocks", lambda: blocks_of(overview))
        smoothness = chosen_strength(fit, blocks, kept, smoothest=not overview.shows_minor_loops)
        if overview.shows_minor_loops:
            least = NOTHING * overview.output_range
            smoothness = borne_strength(fit, rows, smoothness, start_of(parametrization), least)
    normal, moment = fit.gram(rows)
    held = fit.held(smoothness)
    theta = fit.solve(normal + held, moment, start_of(parametrization) + 1.0)
    free = (theta > fit.lower) & (theta < fit.upper)
    effective = effective_count(normal, held, free)
    under_prior = with_prior(parametrization, fit.prior, smoothness, effective)
    left = (fit.columns @ theta - fit.y)[rows]
    rms = float(np.sqrt(np.mean(np.square(left))))
    return GridFit(under_prior, theta, smoothness, rms, correlation_beyond_noise(left))


def best_grid(overview: Overview, even: GridFit, adapted: Callable[[GridFit], GridFit]) -> GridFit:
    """Take an adapted grid where the even one leaves more than noise and the adapted one less.

    Parameters
    ----------
    overview
        The records.
    even
        Fitted.
    adapted
        Fits cells that are narrower where those of a fit have their mass, under a prior of the
        same strength, which means the same on every grid.
    """
    if even.rms <= ROUNDING * overview.output_range or even.correlation <= 1.0:
        return even
    other = adapted(even)
    return other if other.rms < WORTH_IT * even.rms else even


def correlation_beyond_noise(left: Array) -> float:
    """Give the correlation of neighbouring residuals over the largest that counts as noise.

    Parameters
    ----------
    left
        Shape (N,), residuals in order.
    """
    power = float(left @ left)
    found = float(left[:-1] @ left[1:]) / power if power > 0.0 else 0.0
    return found / max(MISFIT, SURE / float(np.sqrt(left.size)))

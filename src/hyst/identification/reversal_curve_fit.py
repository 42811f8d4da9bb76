"""A Preisach model directly from first-order reversal curves, by what lies between thresholds.

On the way down from the top T to a reversal at beta, and on the rise from there, the output is

    y(u) = c - 2 E(T, u) + p0 u,    y(u) = c - 2 E(T, beta) + 2 E(u, beta) + p0 u,

E(alpha, beta) = sum_ij w_ij <share of cell ij between them>, with a level c of its own for each
curve. No memory is followed, so that drift from curve to curve does no harm; what a record says
beside its curves is not used.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number
from hyst.checks.numbers import whole_number as as_whole_number
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.blas_threads import one_blas_thread
from hyst.identification.choice.blocks import Block
from hyst.identification.families.preisach.cells import Cells, adapted_cells, even_cells
from hyst.identification.families.preisach.grid_choice import (
    ADAPTED_LEVELS,
    FEWEST_LEVELS,
    MOST_LEVELS,
    ROUNDING,
    WORTH_IT,
    correlation_beyond_noise,
    levels_for,
)
from hyst.identification.families.preisach.preisach import LARGEST_SMOOTHNESS
from hyst.identification.families.preisach.smoothness import (
    LinearFit,
    chosen_strength,
    effective_count,
)
from hyst.identification.fit.parametrization import SMALLEST_SLOPE
from hyst.models import Preisach
from hyst.operators import Affine, Operator
from hyst.signals import Record, ReversalCurve, reversal_curves

Array = NDArray[np.float64]

AUTO = "auto"
MOST_BLOCKS = 8
SAMPLES_A_STROKE = 400
"""At most: of longer ones so many are taken, evenly spaced."""


@dataclass(frozen=True, eq=False)
class ReversalCurveFit:
    """A Preisach model and how well it describes the curves it was read from.

    Parameters
    ----------
    model
        ``sign (p0 u + relays) + offset``.
    curves
        The curves.
    rms, rms_percent
        Root mean square of what it leaves of the curves, each with its own offset, in output units
        and in percent of their range.
    smoothness
        Strength of the prior, as chosen or given.
    determined
        How many combinations of the weights the curves determine.
    """

    model: Operator
    curves: tuple[ReversalCurve, ...]
    rms: float
    rms_percent: float
    smoothness: float
    determined: int

    @property
    def relays(self) -> Preisach:
        """The relays of the model, without sign and offset."""
        return next(each for each in self.model.parts if isinstance(each, Preisach))  # type: ignore[attr-defined]


def identify_from_reversal_curves(
    records: Record | Sequence[Record],
    levels: int | str = AUTO,
    smoothness: float | str = AUTO,
) -> ReversalCurveFit:
    """Read a Preisach model off first-order reversal curves.

    Parameters
    ----------
    records
        Driven as by ``hyst.signals.forc``; one or more.
    levels
        Cells of the grid along a side, 4 to 48; ``"auto"``: 24, fewer for few samples,
        and 32 that are narrower where relays switch if those leave more than noise.
    smoothness
        Strength of the prior that densities of neighbouring cells are alike, 0 to 100; ``"auto"``:
        what predicts left-out curves best.

    Returns
    -------
    ReversalCurveFit

    Raises
    ------
    InputError
        If an argument is out of range.
    NotIdentifiableError
        If there are fewer than four curves with different reversals, or the output rests.

    Notes
    -----
    D. H. Everett, Trans. Faraday Soc. 51 (1955) 1551; I. D. Mayergoyz, Mathematical Models of
    Hysteresis (1991), eqs. 1.24-1.32, whose mixed difference of the curves, which doubles noise
    at each step, is taken here by non-negative least squares under a prior.

    Examples
    --------
    >>> import hyst
    >>> drive = hyst.signals.forc(0.01, -1.0, 1.0, 1.0)
    >>> even = hyst.Preisach([[1.0]], [-1.0, 1.0], p0=0.2)
    >>> found = identify_from_reversal_curves(Record(drive.u, even(drive.u), 0.01), levels=8)
    >>> float(found.relays.weights.sum().round(4)), round(found.relays.p0, 4)
    (1.0, 0.2)
    """
    curves = tuple(_thinned(each) for each in reversal_curves(records))
    u = np.concatenate([each.u for each in curves])
    y = np.concatenate([each.y for each in curves])
    span, output_range = float(np.ptp(u)), float(np.ptp(y))
    if output_range == 0.0:
        raise NotIdentifiableError("the output rests along all curves; check the sensor")
    count = levels_for(u.size) if levels == AUTO else levels
    side = as_whole_number(count, "levels", FEWEST_LEVELS, MOST_LEVELS, ", or 'auto'")
    strength = None if smoothness == AUTO else _as_strength(smoothness)
    cells = even_cells(float(u.min()), float(u.max()), side)
    sign = 1.0 if float((u - u.mean()) @ y) >= 0.0 else -1.0
    with one_blas_thread():
        found, like_noise = _fitted(curves, cells, strength, (sign, span, output_range))
        if levels != AUTO or like_noise:
            return found
        narrow = adapted_cells(
            cells, found.relays.parameters().values[1:], levels_for(u.size, ADAPTED_LEVELS)
        )
        other, _ = _fitted(curves, narrow, found.smoothness, (sign, span, output_range))
        return other if other.rms < WORTH_IT * found.rms else found


def everett_shares(cells: Cells, alpha: Array, beta: Array) -> Array:
    """Give the share of every cell between two thresholds: of relays up at alpha, down at beta.

    Parameters
    ----------
    cells
        The grid.
    alpha, beta
        Shape (N,), input units, ``alpha >= beta``.

    Returns
    -------
    numpy.ndarray
        Shape (N, cells).
    """
    low, side = cells.thresholds[:-1], np.diff(cells.thresholds)
    rows, columns = cells.places
    below = np.clip((alpha[:, None] - low) / side, 0.0, 1.0)
    above = np.clip((low + side - beta[:, None]) / side, 0.0, 1.0)
    shares: Array = below[:, rows] * above[:, columns]
    # Of a triangle, what is below alpha and above beta is a smaller one.
    shares[:, rows == columns] = np.maximum(below + above - 1.0, 0.0) ** 2
    return shares


def _fitted(
    curves: tuple[ReversalCurve, ...],
    cells: Cells,
    strength: float | None,
    scales: tuple[float, float, float],
) -> tuple[ReversalCurveFit, bool]:
    """Give the fit on a grid, and whether it leaves nothing but noise."""
    sign, span, output_range = scales
    counts = [each.u_down.size + each.u.size for each in curves]
    of_curve = np.repeat(np.arange(len(curves)), counts)
    u = np.concatenate([part for each in curves for part in (each.u_down, each.u)])
    y = sign * np.concatenate([part for each in curves for part in (each.y_down, each.y)])
    columns = np.column_stack([u, 2.0 * np.concatenate([_moved(cells, each) for each in curves])])
    fit = _without_offsets(columns, y, of_curve, cells, SMALLEST_SLOPE * output_range / span)
    chosen = strength
    if chosen is None:
        chosen = chosen_strength(fit, _blocks(of_curve), None, smoothest=False)
    every = np.ones(y.size, dtype=bool)
    normal, moment = fit.gram(every)
    held = fit.held(chosen)
    theta = fit.solve(normal + held, moment, fit.lower + 1.0)
    left = fit.columns @ theta - fit.y
    weights = np.zeros((cells.levels, cells.levels))
    weights[cells.places] = theta[1:]
    relays = Preisach(weights, cells.thresholds, float(theta[0]))
    # At the top all relays are up.
    offset = sign * float(np.mean(y - columns @ theta) - theta[1:].sum())
    rms = float(np.sqrt(np.mean(np.square(left))))
    determined = effective_count(normal, held, theta > fit.lower)
    model = Affine(sign, offset) @ relays
    found = ReversalCurveFit(
        model, curves, rms, 100.0 * rms / output_range, chosen, round(determined)
    )
    small = rms <= ROUNDING * output_range
    return found, small or correlation_beyond_noise(left) <= 1.0


def _moved(cells: Cells, curve: ReversalCurve) -> Array:
    """Give the share of every cell that has turned since the top, shape (M + N, cells), <= 0."""
    top = cells.thresholds[-1]
    down = -everett_shares(cells, np.full(curve.u_down.size, top), curve.u_down)
    lowest = -everett_shares(cells, np.array([top]), np.array([curve.beta]))
    up = lowest + everett_shares(cells, curve.u, np.full(curve.u.size, curve.beta))
    return np.concatenate([down, up])


def _without_offsets(
    columns: Array, y: Array, of_curve: NDArray[np.intp], cells: Cells, least_slope: float
) -> LinearFit:
    """Take the mean of every curve out, which is the same as an offset for each."""
    counts = np.bincount(of_curve)
    means = np.stack([np.bincount(of_curve, each) / counts for each in columns.T], axis=1)
    centred = columns - means[of_curve]
    left = y - (np.bincount(of_curve, y) / counts)[of_curve]
    slopes = cells.differences() / (0.5 * float(np.ptp(y)))
    prior = np.column_stack([np.zeros(len(slopes)), slopes])
    lower = np.zeros(columns.shape[1])
    lower[0] = least_slope
    return LinearFit(centred, left, lower, np.full(lower.size, np.inf), prior)


def _blocks(of_curve: NDArray[np.intp]) -> list[Block]:
    """Leave every eighth curve out, so that its neighbours must tell it."""
    count = min(MOST_BLOCKS, int(of_curve.max()) + 1)
    rows = [of_curve % count == each for each in range(count)]
    return [Block(each, of_curve[each]) for each in rows]


def _thinned(curve: ReversalCurve) -> ReversalCurve:
    up, down = (_places(size) for size in (curve.u.size, curve.u_down.size))
    return ReversalCurve(
        curve.beta, curve.u[up], curve.y[up], curve.u_down[down], curve.y_down[down]
    )


def _places(size: int) -> NDArray[np.intp]:
    count = min(size, SAMPLES_A_STROKE)
    return np.round(np.linspace(0, max(size - 1, 0), count)).astype(np.intp)


def _as_strength(value: Any) -> float:
    number = as_number(value, "smoothness")
    if not 0.0 <= number <= LARGEST_SMOOTHNESS:
        raise InputError(
            f"smoothness is {number}; give {AUTO!r} or a number from 0 to {LARGEST_SMOOTHNESS:g}"
        )
    return number

"""How steep a hysteresis with an inexact inverse before it can be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive
from hyst.compensation.error_of_inverse.slope_steps import SlopeSteps
from hyst.models.mapped_plays import MappedPlays
from hyst.models.piecewise_map import PiecewiseMap, largest_distance
from hyst.operators import Operator

Array = NDArray[np.float64]

# Slopes and distances of a map and its inverse, one after the other, to rounding.
_ROUNDING = 1e-9


def slope_range(
    model: Operator, approximate_inverse: Operator, y_max: float
) -> tuple[float, float]:
    """Give the least and largest slope of ``model(approximate_inverse(v))`` over ``v``.

    The plays that move at an instant are always the innermost ones, so the rate of a bank's output
    is ``phi(s) du/dt`` for some s, phi the cumulative weights. What a controller sees of an inexact
    inverse is therefore a gain that varies within these two numbers, 1 and 1 if it is exact.

    Parameters
    ----------
    model, approximate_inverse
        As in ``error_bound``; the model need not be invertible.
    y_max
        Largest ``|v|``, positive, output units of the model.

    Returns
    -------
    low, high : float
        For plays alone, with a rising approximate inverse, the range itself; else one around it.

    Raises
    ------
    InputError
        As ``error_bound``.

    Notes
    -----
    With plays alone the two banks together are one, of slopes ``phi(f_hat(s)) phi_hat(s)``, f_hat
    the loading curve of the inverse. Maps that are not inverse to one another multiply the ranges.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> from hyst.operators import Affine
    >>> model = PrandtlIshlinskii([1.0], [1.0], p0=1.0)
    >>> slope_range(model, model.inverse(), 5.0), slope_range(model, Affine(1.0), 5.0)
    ((1.0, 1.0), (1.0, 2.0))
    """
    reach = as_positive(y_max, "y_max", "the largest |v|")
    own = MappedPlays.of(model, "the model")
    # Gains move into plays wherever the model has no map to undo.
    like = MappedPlays(own.after, own.plays, own.before)
    approximate = MappedPlays.of(approximate_inverse, "the approximate inverse", like=like)
    first = _slopes(approximate.before, reach)
    into = approximate.before.largest_value(reach)
    between = PiecewiseMap((*approximate.after.stages, *own.before.stages))
    phi, phi_hat = SlopeSteps.of(own.plays), SlopeSteps.of(approximate.plays)
    out = phi_hat.largest_output(into)
    inner = _composed(phi, phi_hat, between, into)
    end = phi.largest_output(between.largest_value(out))
    last = _slopes(own.after, end)
    # Only where the plays cancel does the last map meet again what the first one made.
    cancelled = bool(np.abs(inner - 1.0).max() <= _ROUNDING)
    if cancelled and _undo(approximate.before, own.after, reach):
        return float(inner.min()), float(inner.max())
    return _product(_product(_range(first), _range(inner)), _range(last))


def _composed(phi: SlopeSteps, phi_hat: SlopeSteps, between: PiecewiseMap, reach: float) -> Array:
    """Slopes of the plays, the map between and the plays of the inverse, one after the other."""
    edges, rising = phi_hat.integral(reach)
    out = float(rising[-1])
    inverse = phi_hat.pieces(reach)[1]
    distance = largest_distance(between, PiecewiseMap(), (out, out), 0.0)
    if inverse.min() < 0.0 or distance > _ROUNDING * max(out, 1.0):
        outer = phi.pieces(between.largest_value(out))[1]
        both = _product(_range(inverse), _range(_slopes(between, out)))
        return np.array(_product(both, _range(outer)))
    starts = np.union1d(rising[:-1], phi.starts[phi.starts < out * (1.0 - _ROUNDING)])
    # A threshold that the inverse meets exactly must not leave a sliver of the wrong slope.
    keep = np.append(np.diff(starts) > _ROUNDING * out, True)
    middles = 0.5 * (starts[keep] + np.append(starts[keep][1:], out))
    piece = np.searchsorted(rising, middles, side="right") - 1
    return np.asarray(phi(middles) * phi_hat(edges[piece]))


def _slopes(bend: PiecewiseMap, reach: float) -> Array:
    corners = bend.corners(-reach, reach)
    return bend.slope(0.5 * (corners[1:] + corners[:-1]))


def _undo(first: PiecewiseMap, then: PiecewiseMap, reach: float) -> bool:
    both = PiecewiseMap((*first.stages, *then.stages))
    return largest_distance(both, PiecewiseMap(), (reach, reach), 0.0) <= _ROUNDING * reach


def _range(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _product(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    ends = [x * y for x in a for y in b]
    return min(ends), max(ends)

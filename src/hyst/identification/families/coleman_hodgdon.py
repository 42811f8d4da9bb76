"""Coleman and Hodgdon's hysteresis: a curve that the output relaxes to over the input's way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from hyst import models
from hyst.errors import NotIdentifiableError, NotInvertibleError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import option, whole_number
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Affine, Composition

Array = NDArray[np.float64]

MOST_PIECES = 12

_WAYS = np.geomspace(0.03, 3.0, 13)
"""1 / alpha of first guesses, over half the input range."""
_CLEAR = 10.0
"""By how many variances of the noise a constant of the loop lowers the squared error at least."""
_ROUNDING = 1e-9
_LEAST_LOOP = 1e-3
"""Share of the slopes that a loop is at least made of."""


@final
@dataclass(frozen=True)
class ColemanHodgdon(Family):
    """``y = sign C[u] + offset``, ``dC/du = alpha s (f(u) - C) + g(u)``, s = sgn(du).

    Parameters
    ----------
    pieces
        Linear pieces of f, and values of g, on each side of 0: 1 is the form usual for piezos, 3 or
        more describe what saturates. Their ends lie evenly between 0 and the largest ``|u|``.
    """

    name = "coleman-hodgdon"
    in_reserve = True
    words = Words(
        full_name="Coleman-Hodgdon model",
        equations=(
            "y(t) = {sign}C[u](t) + offset",
            "dC/du = \u03b1 s (f(u) - C) + g(u),  s = sgn(du)",
        ),
        explanations=(
            "The output relaxes to a curve f with the slopes a, over a way 1 / \u03b1 (alpha) of "
            "the input, and moves with the slope b = g(u) <= a where it crosses f; the loop is as "
            "wide as a is above b. Minor loops drift until they close, unlike those of plays.",
        ),
    )

    pieces: Any = option(
        1, whole_number(1, MOST_PIECES, "Linear pieces of the curve on each side of 0.")
    )

    def least_parameters(self, size: int) -> int:
        """Give alpha, the offset, and two slopes a piece."""
        return 2 + 2 * int(self.pieces)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best points of a grid over alpha, the slopes by least squares without signs."""
        guesses = [
            self._guess(overview, 1.0 / (float(way) * overview.data.half_range)) for way in _WAYS
        ]
        guesses.sort(key=lambda each: each[0])
        if not self._shows_a_loop(overview, guesses[0][0]):
            raise NotIdentifiableError(
                "the output shows no loop that lags the input, as a Coleman-Hodgdon model does; "
                "use family 'linear', or 'dahl' for friction"
            )
        return [self._parametrize(overview, *guess) for _, guess in guesses[: max(most, 2)]]

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say where there is no inverse, and whether the record sees 1 / alpha."""
        model = _model_of(fit)
        told = []
        try:
            model.require_inverse()
        except NotInvertibleError as refused:
            told.append(f"this model has no exact inverse: {refused}")
        way = 1.0 / model.alpha
        if way > 2.0 * data.half_range:
            told.append(
                f"a branch forgets its turn over a way of {way:.4g}, longer than the strokes of "
                "the record: alpha, a and b are extrapolations, of which it shows products only"
            )
        return tuple(told)

    def _shows_a_loop(self, overview: Overview, residual: float) -> bool:
        """Tell whether a loop explains more than a curve without one, noise and rounding aside."""
        y, knots = overview.data.measured(), self._knots(overview)
        columns = [
            model_output(overview.data, models.ColemanHodgdon(1.0, each, each, knots))
            for each in np.eye(int(self.pieces))
        ]
        matrix = overview.sign * np.column_stack(columns)
        _, without = nnls(matrix - matrix.mean(axis=0), y - y.mean())
        noise = _CLEAR * (int(self.pieces) + 1) / y.size
        is_rounding = without <= _ROUNDING * overview.output_range * np.sqrt(y.size)
        return bool(not is_rounding and residual**2 * (1.0 + noise) < without**2)

    def _knots(self, overview: Overview) -> Array:
        count = int(self.pieces)
        largest = float(np.abs(overview.input).max())
        return largest * np.arange(1, count) / count

    def _guess(self, overview: Overview, alpha: float) -> tuple[float, tuple[Any, ...]]:
        """Residual, and alpha, knots, b or its surplus, a - b and offset of the best slopes."""
        knots, count = self._knots(overview), int(self.pieces)
        shapes = [self._slopes(each) for each in np.eye(2 * count)]
        columns = [
            overview.sign * model_output(overview.data, models.ColemanHodgdon(alpha, a, b, knots))
            for a, b in shapes
        ]
        y, matrix = overview.data.measured(), np.column_stack(columns)
        middle, mean = matrix.mean(axis=0), y.mean()
        slopes, residual = nnls(matrix - middle, y - mean)
        offset = float(mean - middle @ slopes)
        return float(residual), (alpha, knots, slopes[:count], slopes[count:], offset)

    def _slopes(self, free: Array) -> tuple[Array, Array]:
        """Give a and b of free slopes: the surplus and the width of the loop of every piece.

        Of one piece the surplus is 2 b - a, so that it has an inverse; of several it is b.
        """
        count = int(self.pieces)
        surplus, width = free[:count], free[count:]
        b = surplus + width if count == 1 else surplus
        return b + width, b

    def _parametrize(
        self,
        overview: Overview,
        alpha: float,
        knots: Array,
        surplus: Array,
        width: Array,
        offset: float,
    ) -> Start:
        """Lay out theta = (alpha, surplus, width, offset)."""
        count = int(self.pieces)
        slope, half = overview.mean_slope, overview.data.half_range
        surplus = np.maximum(surplus, 10.0 * SMALLEST_SLOPE * slope)
        width = np.maximum(width, 10.0 * _LEAST_LOOP * slope)
        a, b = self._slopes(np.concatenate([surplus, width]))
        template = Affine(overview.sign, offset) @ models.ColemanHodgdon(alpha, a, b, knots)
        fixed = template.parameters().values.copy()
        transform = np.zeros((fixed.size, 2 + 2 * count))
        transform[0, 0] = transform[-1, -1] = 1.0
        for place, free in enumerate(np.eye(2 * count)):
            transform[1 : 1 + 2 * count, 1 + place] = np.concatenate(self._slopes(free))
        fixed[: 1 + 2 * count] = fixed[-1] = 0.0
        least = np.full(count, SMALLEST_SLOPE * slope)
        lower = np.concatenate([[1e-2 / half], least, np.zeros(count), [-np.inf]])
        upper = np.full(2 + 2 * count, np.inf)
        upper[0] = 1e3 / half
        theta = np.concatenate([[alpha], surplus, width, [offset]])
        return Parametrization(template, transform, fixed, lower, upper), theta


def _model_of(fit: Fit) -> models.ColemanHodgdon:
    """Give the model inside a fit."""
    operator = fit.operator
    parts = operator.parts if isinstance(operator, Composition) else (operator,)
    return next(each for each in parts if isinstance(each, models.ColemanHodgdon))

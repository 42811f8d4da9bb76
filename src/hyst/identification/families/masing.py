"""A loading curve whose slope goes from one value to another, with nested memory of reversals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import choice, option
from hyst.identification.families.power_law_fit import SMALLEST_GAIN, largest_power
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization
from hyst.identification.fit.problem import model_output
from hyst.identification.fit.shape_search import least_over, saved_beside_a_line, shares
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import ExponentialCurve
from hyst.operators import Affine

Array = NDArray[np.float64]

EXPONENTIAL, SATURATING = "exponential", "saturating"

LONGEST_WAY = 5.0
"""Of b, over half the input range: beyond, the slope grows evenly, and only d / b shows."""


@final
@dataclass(frozen=True)
class Masing(Family):
    """``dy/du = c - d exp(-p / (2 b))``, p the way since the last reversal; reversals are nested.

    Parameters
    ----------
    curve
        ``"exponential"``: the slope grows or falls from c - d to c; ``"saturating"``: it falls to
        0, c = 0, so that the output has a limit.
    """

    name = "masing"
    in_reserve = True
    explains = ("run direction",)  # where the slope falls it is right, as of friction
    words = Words(
        full_name="exponential model with Masing memory",
        equations=(
            "y(t) = {sign}M[u](t) + offset",
            "dM/du = c - d exp(-p / (2 b)),  p = |u - u at the last reversal|",
        ),
        explanations=(
            "Right after a reversal the output follows the input with the slope c - d; over a way "
            "of some 2 b the slope becomes c. It grows where d is positive, and falls where d is "
            "negative, as of friction; with c = 0 the output saturates. A branch that closes a "
            "loop goes on along the branch the loop started from, so that minor loops close.",
        ),
    )
    has_memory = False  # a delay bends such a loop as another way b does

    curve: Any = option(
        EXPONENTIAL,
        choice((EXPONENTIAL, SATURATING), "Slope from c - d to c, or to 0, so that it saturates."),
    )

    def least_parameters(self, size: int) -> int:
        """Give 4, c, d, b and the offset, or one less without c."""
        return 3 + int(self.curve == EXPONENTIAL)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best way b of a search, the slopes by least squares."""
        unit = overview.data.half_range
        y = overview.sign * overview.data.measured()
        target = y - y.mean()
        line = overview.input - overview.input.mean()
        curves = self._unit_curves()

        def table(b: float) -> tuple[Array, Array]:
            columns = [
                model_output(overview.data, models.MasingOperator(ExponentialCurve(c, d, b)))
                for c, d in curves
            ]
            return np.column_stack([each - each.mean() for each in columns]), target

        low = unit / (largest_power(overview.data) + 1.0)
        b, _ = least_over(lambda b: shares(*table(b))[1], low, LONGEST_WAY * unit)
        slopes, left = shares(*table(b))
        if saved_beside_a_line(line, target, left) < SMALLEST_GAIN:
            raise NotIdentifiableError(
                "an exponential describes the records no better than a straight line, but for "
                "noise; use family 'linear' or 'pi'"
            )
        return [self._parametrize(overview, slopes, b, (low, LONGEST_WAY * unit))]

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say which constants are on a bound, or an extrapolation."""
        # theta is in the units of the fit, as its bounds are; the operator is in the user's.
        theta, shape = fit.solution.theta, fit.parametrization
        b = float(fit.operator.parameters().values[2])
        said = []
        if self.curve == EXPONENTIAL and theta[0] <= shape.lower[0]:
            said.append(
                "the slope right after a turn, c - d, came out at its lower bound, a thousandth of "
                "the mean slope: the output rests at first, and the inverse answers small changes "
                "there with large ones"
            )
        if self.curve == EXPONENTIAL and theta[1] <= shape.lower[1]:
            said.append(
                "the slope far from a turn, c, came out at its lower bound, a thousandth of the "
                "mean slope: the output saturates; the option curve 'saturating' has c = 0"
            )
        on_upper = theta[-2] >= shape.upper[-2] * (1.0 - 1e-3)
        if on_upper or theta[-2] <= shape.lower[-2] * (1.0 + 1e-3):
            said.append(
                f"b came out at its {'upper' if on_upper else 'lower'} limit {b:.4g}: the slope "
                "changes over another way than this record can tell, so c, d and b are no "
                "estimates; compare family 'ramberg-osgood' or 'pi'"
            )
        elif data.half_range < b:
            share = 100.0 * (1.0 - np.exp(-data.half_range / b))
            said.append(
                f"the slope goes {share:.0f} % of the way to its last value c on this record: c is "
                "an extrapolation; drive the actuator further"
            )
        return tuple(said)

    def _unit_curves(self) -> tuple[tuple[float, float], ...]:
        """Give c and d of the curves whose sum with slopes of 0 or more is any of the family."""
        # The slope of the first falls from 1 to 0, that of the second grows from 0 to 1.
        return ((0.0, -1.0), (1.0, 1.0)) if self.curve == EXPONENTIAL else ((0.0, -1.0),)

    def _parametrize(
        self, overview: Overview, slopes: Array, b: float, ways: tuple[float, float]
    ) -> Start:
        """Lay out theta = (first slope, last slope unless it is 0, b, offset)."""
        least = SMALLEST_SLOPE * overview.mean_slope
        count = slopes.size
        theta = np.concatenate([np.maximum(slopes, least), [b, 0.0]])
        transform = np.zeros((5, count + 2))
        transform[1, 0] = -1.0  # d = last - first
        if count == 2:
            transform[0, 1] = transform[1, 1] = 1.0
        transform[2, count] = transform[4, count + 1] = 1.0
        fixed = np.array([0.0, 0.0, 0.0, overview.sign, 0.0])
        curve = ExponentialCurve(*(transform[:3] @ theta).tolist())
        model = models.MasingOperator(curve)
        theta[-1] = float(
            np.mean(overview.data.measured() - overview.sign * model_output(overview.data, model))
        )
        return Parametrization(
            template=Affine(overview.sign, theta[-1]) @ model,
            transform=transform,
            fixed=fixed,
            lower=np.array([*[least] * count, ways[0], -np.inf]),
            upper=np.array([*[np.inf] * count, ways[1], np.inf]),
        ), theta

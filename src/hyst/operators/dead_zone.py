"""Superposition of dead-zone functions: the piecewise linear map before or after hysteresis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, refuse_overflow
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.base import Operator
from hyst.operators.cumulative_weights import cumulative, rounding_of_cumulative
from hyst.operators.inequalities import MARGIN, Inequalities, stacked, within
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.portrait import MAP, Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]
Variant = Literal["two-sided", "by-direction"]


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class DeadZone(Operator):
    """Sum of dead-zone functions: ``y = sum_i w_i S(u, rho_i)``, a piecewise linear map.

    ``two-sided``: ``S(u, rho)`` is ``max(u - rho, 0)`` for ``rho > 0``, ``min(u - rho, 0)`` for
    ``rho < 0`` and ``u`` for ``rho = 0``.
    ``by-direction``: the form printed in S0 eq. 3: ``u - rho`` while the input rises above
    ``rho``, ``u + rho`` while it falls below ``-rho``, 0 otherwise, also while it rests. It jumps,
    and has no inverse.

    Parameters
    ----------
    weights
        Shape (m,), output units per input unit, any sign.
    thresholds
        Shape (m,), input units, any order and sign.
    variant
        ``"two-sided"`` or ``"by-direction"``.

    Raises
    ------
    InputError
        If the lengths differ, m is 0, a constant is not finite, or the variant is unknown.

    Notes
    -----
    S1 eqs. 49-55, S4 eqs. 29-33, S0 eqs. 2-3.

    Examples
    --------
    >>> DeadZone([1.0, 0.5], [0.0, 1.0])([-2.0, 0.5, 3.0])
    array([-2. ,  0.5,  4. ])
    """

    weights: Array
    thresholds: Array
    variant: Variant

    kind = "dead-zone"
    is_map = True

    def __init__(
        self, weights: ArrayLike, thresholds: ArrayLike, variant: Variant = "two-sided"
    ) -> None:
        w, rho = as_constants(weights, "weights"), as_constants(thresholds, "thresholds")
        if w.size != rho.size:
            raise InputError(f"{w.size} weights but {rho.size} thresholds; give one for each")
        if w.size == 0:
            raise InputError("a dead-zone map needs at least one weight and threshold")
        if not isinstance(variant, str) or variant not in ("two-sided", "by-direction"):
            raise InputError(f"variant is {variant!r}; choose 'two-sided' or 'by-direction'")
        object.__setattr__(self, "weights", w)
        object.__setattr__(self, "thresholds", rho)
        object.__setattr__(self, "variant", variant)

    @classmethod
    def odd(cls, weights: ArrayLike, thresholds: ArrayLike) -> DeadZone:
        """Give the odd extension of a map that is given for inputs >= 0.

        Parameters
        ----------
        weights, thresholds
            Shape (m,); thresholds zero or positive (S1 eq. 51). A threshold of 0 is the linear
            part; the others are mirrored to negative inputs.

        Returns
        -------
        DeadZone

        Raises
        ------
        InputError
            If a threshold is negative, or as in the constructor.

        Notes
        -----
        S1 sec. 2.1 requires an odd envelope, which eqs. 49-50 alone do not give.

        Examples
        --------
        >>> DeadZone.odd([1.0, 0.5], [0.0, 1.0])([-3.0, 3.0])
        array([-4.,  4.])
        """
        w, rho = as_constants(weights, "weights"), as_constants(thresholds, "thresholds")
        if rho.size and rho.min() < 0.0:
            raise InputError(f"thresholds go down to {rho.min()}; give those of inputs >= 0 only")
        if w.size != rho.size:
            raise InputError(f"{w.size} weights but {rho.size} thresholds; give one for each")
        mirrored = rho > 0.0
        return cls(
            np.concatenate([w, w[mirrored]]), np.concatenate([rho, -rho[mirrored]]), "two-sided"
        )

    def traits(self) -> Traits:
        """Give the traits; the form by direction keeps none of them."""
        plain = self.variant == "two-sided"
        return Traits(
            memoryless=plain,
            rate_independent=Degree.EXACTLY if plain else Degree.NO,
            return_point_memory=plain,
            congruent_loops=plain,
            monotone=lambda: plain and bool(self._slopes().min() >= 0.0),
            invertible=self.is_invertible,
        )

    def initial_state(self) -> Array:
        """Give an empty array, or for the form by direction the previous input, 0."""
        return np.zeros(0 if self.variant == "two-sided" else 1)

    def exact_inverse(self) -> DeadZone:
        """Give the exact inverse, again a dead-zone map.

        Thresholds are the images of the thresholds, weights
        ``-w_i / (c_i c_{i-1})``, c the slopes of the pieces between them, on either side from the
        linear part c_0 outwards, ``c_i = c_{i-1} + w_i``.

        Raises
        ------
        NotInvertibleError
            If the map is not strictly monotone, or flat to rounding; the flat or reversed piece is
            named. If a constant of the inverse overflows. Also for the form by direction, which
            jumps.

        Notes
        -----
        S1 eqs. 52-55, S4 eqs. 31-33 (whose Gamma is Lambda).
        """
        if self.variant == "by-direction":
            raise NotInvertibleError(
                "a dead-zone map by direction (S0 eq. 3 as printed) jumps and has no inverse; "
                "use variant='two-sided'"
            )
        slope = self._linear_part()
        if abs(slope) <= rounding_of_cumulative(0.0, self.weights[self.thresholds == 0.0])[-1]:
            raise NotInvertibleError(
                "the map is flat around 0 (no weight at threshold 0, or one of zero); "
                "give it a linear part"
            )
        with np.errstate(all="ignore"):
            right = self._inverse_side(1.0, slope)
            left = self._inverse_side(-1.0, slope)
            weights = np.concatenate([[1.0 / slope], right[0], left[0]])
            images = np.concatenate([right[1], left[1]])
            # An image of 0 would turn a one-sided term into a linear one: 1/0 is an overflow too.
            refuse_overflow(weights, images, 1.0 / images)
        return DeadZone(weights, np.concatenate([[0.0], images]))

    def parameters(self) -> Parameters:
        """Give weights, then thresholds; a threshold keeps its sign, since S jumps across 0."""
        count = self.weights.size
        tiny = np.nextafter(0.0, 1.0)
        rho = self.thresholds
        free = np.full(count, np.inf)
        return Parameters(
            values=np.concatenate([self.weights, rho]),
            names=numbered("weights", count) + numbered("thresholds", count),
            lower=np.concatenate([-free, np.select([rho > 0, rho < 0], [tiny, -free], 0.0)]),
            upper=np.concatenate([free, np.select([rho > 0, rho < 0], [free, -tiny], 0.0)]),
        )

    def inequalities(self) -> Inequalities:
        """Give slopes of the sign of the linear part, and thresholds that keep their order."""
        count, rho = self.weights.size, self.thresholds
        sign = math.copysign(1.0, self._linear_part())
        middle = np.where(rho == 0.0, sign, 0.0)
        slopes, gaps = [middle], []
        for side in (1.0, -1.0):
            slope, last = middle, np.zeros(count)
            for place in np.unique(side * rho[side * rho > 0.0]).tolist():
                here = side * rho == place
                slope = slope + sign * here
                slopes.append(slope)
                first = side * np.eye(count)[int(np.argmax(here))]
                gaps.append(first - last)
                last = first
        weights, size = (float(np.abs(each).sum()) for each in (self.weights, rho))
        pieces = np.hstack([np.array(slopes), np.zeros((len(slopes), count))])
        apart = np.zeros((len(gaps), 2 * count))
        if gaps:
            apart[:, count:] = gaps
        far = Inequalities(apart, np.full(len(gaps), MARGIN * size))
        return stacked(within(pieces, weights), far)

    def with_parameters(self, theta: Sequence[float] | Array) -> DeadZone:
        """Give a map with other weights and thresholds."""
        count = self.weights.size
        vector = as_parameter_vector(theta, 2 * count)
        return DeadZone(vector[:count], vector[count:], self.variant)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of weights and thresholds."""
        return np.repeat([output_scale / input_scale, input_scale], self.weights.size)

    def keeps_unit(self) -> bool:
        """Tell whether the slope around 0 is 1."""
        return bool(np.isclose(self.weights[self.thresholds == 0.0].sum(), 1.0, rtol=1e-9))

    def portrait(self) -> Portrait:
        """Show the map."""
        return MAP

    def lipschitz_constant(self) -> float:
        """Give the steepest slope; infinity for the form by direction, which jumps."""
        if self.variant == "by-direction":
            return float("inf")
        return float(np.abs(self._slopes()).max())

    def to_dict(self) -> dict[str, Any]:
        """Give kind, weights, thresholds and variant."""
        return {
            "kind": self.kind,
            "weights": self.weights.tolist(),
            "thresholds": self.thresholds.tolist(),
            "variant": self.variant,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> DeadZone:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("weights", "thresholds", "variant")))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        kind = "direction_dead_zone" if self.variant == "by-direction" else "dead_zone"
        return (Stage(kind, (*self.weights.tolist(), *self.thresholds.tolist())),)

    def _linear_part(self) -> float:
        return float(cumulative(0.0, self.weights[self.thresholds == 0.0])[-1])

    def _side(self, sign: float) -> tuple[Array, Array]:
        """Distances of the thresholds on one side of 0, ascending, and their summed weights."""
        chosen = sign * self.thresholds > 0.0
        distance, place = np.unique(sign * self.thresholds[chosen], return_inverse=True)
        summed = np.zeros(distance.size)
        with np.errstate(over="ignore"):
            np.add.at(summed, place, self.weights[chosen])
        return distance, summed

    def _slopes(self) -> Array:
        """Slopes of all pieces, from the middle to the right, then from the middle to the left."""
        slope = self._linear_part()
        return np.concatenate([cumulative(slope, self._side(sign)[1]) for sign in (1.0, -1.0)])

    def _inverse_side(self, sign: float, slope: float) -> tuple[Array, Array]:
        """Weights and thresholds of the inverse on one side of 0."""
        distance, weights = self._side(sign)
        slopes = cumulative(slope, weights)
        refuse_overflow(slopes)
        wrong = np.flatnonzero(slopes * np.sign(slope) <= rounding_of_cumulative(slope, weights))
        if wrong.size:
            piece = int(wrong[0])
            raise NotInvertibleError(
                f"the map is not strictly monotone: beyond threshold "
                f"{sign * distance[piece - 1]:.6g} its slope (sum of the weights up to there) is "
                f"{slopes[piece]:.6g}, around 0 it is {slope:.6g}"
            )
        images = np.cumsum(slopes[:-1] * np.diff(distance, prepend=0.0))
        return -(weights / slopes[1:]) / slopes[:-1], sign * images

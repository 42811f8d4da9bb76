"""The piecewise linear loading curve: plays, or a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, refuse_overflow
from hyst.checks.numbers import as_number
from hyst.checks.thresholds import as_weights_and_thresholds
from hyst.errors import InputError
from hyst.models.loading_curve import LoadingCurve, ReversalMemory, refuse_flat, register_curve
from hyst.operators.parameters import Parameters, as_parameter_vector, parameters_of_plays
from hyst.operators.registry import entries
from hyst.operators.stage import Stage

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, init=False)
class PiecewiseLinear(LoadingCurve):
    """Piecewise linear curve: ``f(x) = p0 x + sum_i p_i max(x - r_i, 0)``.

    With nested memory this is the Prandtl-Ishlinskii operator of these constants.

    Parameters
    ----------
    p
        Shape (n,), changes of slope, output units per input unit.
    r
        Shape (n,), where they are, ``0 <= r_1 <= ... <= r_n``, input units.
    p0
        Slope from 0 on.

    Raises
    ------
    InputError
        If lengths differ, ``r`` is negative or unsorted, a slope ``p0 + p_1 + .. + p_j`` is
        negative, or a constant is not finite.

    Examples
    --------
    >>> PiecewiseLinear([2.0], [1.0], p0=1.0)([0.5, 1.0, 2.0])
    array([0.5, 1. , 4. ])
    """

    p: Array
    r: Array
    p0: float

    kind = "piecewise-linear"

    def __init__(self, p: ArrayLike, r: ArrayLike, p0: float = 0.0) -> None:
        weights, thresholds = as_weights_and_thresholds(p, r)
        object.__setattr__(self, "p", weights)
        object.__setattr__(self, "r", thresholds)
        object.__setattr__(self, "p0", as_number(p0, "p0"))
        slopes = self._slopes()
        falling = np.flatnonzero(slopes < -1e-14 * np.abs(slopes).max())
        if falling.size:
            j = int(falling[0])
            raise InputError(
                f"the slope p0 + p[1] + .. + p[{j}] is {slopes[j]:.6g}; a loading curve never "
                "falls, so give slopes of 0 or more"
            )

    @classmethod
    def from_points(cls, x: ArrayLike, f: ArrayLike) -> PiecewiseLinear:
        """Give the curve through (0, 0) and the points of a table, straight on beyond the last.

        Parameters
        ----------
        x
            Shape (n,), strictly ascending from above 0, input units.
        f
            Shape (n,), not falling, output units.

        Returns
        -------
        PiecewiseLinear

        Raises
        ------
        InputError
            If there is no point, lengths differ, ``x`` does not ascend or ``f`` falls.

        Examples
        --------
        >>> PiecewiseLinear.from_points([1.0, 2.0], [1.0, 4.0])([3.0])
        array([7.])
        """
        at, value = as_constants(x, "x"), as_constants(f, "f")
        if at.size == 0 or at.size != value.size:
            raise InputError(
                f"the table has {at.size} x and {value.size} f; give one or more of each, as many"
            )
        steps = np.diff(at, prepend=0.0)
        if steps.min() <= 0.0:
            i = int(np.argmin(steps))
            raise InputError(f"x[{i}] is {at[i]:.6g}; give x strictly ascending from above 0")
        slopes = np.diff(value, prepend=0.0) / steps
        return cls(np.diff(slopes), at[:-1], float(slopes[0]))

    def __call__(self, x: ArrayLike) -> Array:
        """Give f(x), odd, in the shape of x."""
        values = np.asarray(x, dtype=np.float64)
        along = np.abs(values)
        f = self.p0 * along + np.maximum(along[..., None] - self.r, 0.0) @ self.p
        return np.asarray(np.copysign(f, values))

    def inverse(self) -> PiecewiseLinear:
        """Give the inverse, again piecewise linear (S1 eqs. 7-8).

        Raises
        ------
        NotInvertibleError
            If f is flat somewhere, or a constant of the inverse overflows.
        """
        slopes = self._slopes()
        starts = np.concatenate([[0.0], self.r])
        flat = np.flatnonzero(slopes <= 1e-14 * np.abs(slopes).max())
        # A piece of no length does not count: thresholds may repeat, or be 0.
        flat = flat[np.append(np.diff(starts), np.inf)[flat] > 0.0]
        refuse_flat(float(starts[flat[0]]) if flat.size else None)
        keep = np.append(np.diff(starts), np.inf) > 0.0
        slopes, starts = slopes[keep], starts[keep]
        with np.errstate(all="ignore"):
            inverse_slopes = 1.0 / slopes
            images = np.cumsum(slopes[:-1] * np.diff(starts))
        refuse_overflow(inverse_slopes, images)
        return PiecewiseLinear(np.diff(inverse_slopes), images, float(inverse_slopes[0]))

    def extreme_slopes(self) -> Array:
        """Give the slopes of all pieces."""
        return self._slopes()

    @property
    def is_straight(self) -> bool:
        """Whether there is one slope only."""
        return not self.p.any()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PiecewiseLinear) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash((self.p0, *self.p.tolist(), *self.r.tolist()))

    def parameters(self) -> Parameters:
        """Give p0, p, then r."""
        return parameters_of_plays(self.p0, self.p, self.r)

    def with_parameters(self, theta: Sequence[float] | Array) -> PiecewiseLinear:
        """Give a curve with other slopes."""
        n = self.p.size
        vector = as_parameter_vector(theta, 1 + 2 * n)
        return PiecewiseLinear(vector[1 : n + 1], vector[n + 1 :], float(vector[0]))

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of p0, p and r."""
        n = self.p.size
        return np.repeat([output_scale / input_scale, input_scale], [n + 1, n])

    def to_dict(self) -> dict[str, Any]:
        """Give kind, p0, p and r."""
        return {"kind": self.kind, "p0": self.p0, "p": self.p.tolist(), "r": self.r.tolist()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> PiecewiseLinear:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("p", "r", "p0")))

    def stage(self, memory: ReversalMemory, inverse: bool) -> Stage:
        """Give the stage of this curve with a ``memory`` of reversals, or of its ``inverse``."""
        return memory.stage("plays", (self.p0, *self.p.tolist(), *self.r.tolist()), inverse)

    def _slopes(self) -> Array:
        return np.cumsum(np.concatenate([[self.p0], self.p]))


register_curve(PiecewiseLinear)

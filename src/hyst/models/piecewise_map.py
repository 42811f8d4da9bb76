"""A chain of memoryless, piecewise linear operators with its corners and slopes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.operators import Affine, DeadZone

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class PiecewiseMap:
    """Piecewise linear function: stages one after the other, the identity if there is none.

    Parameters
    ----------
    stages
        Affine maps and two-sided dead zones, in the order of the signal.

    Examples
    --------
    >>> bend = PiecewiseMap((Affine(2.0), DeadZone([1.0, 0.5], [0.0, 3.0])))
    >>> bend.corners(-2.0, 2.0), bend.slope(np.array([0.0, 1.6]))
    (array([-2. ,  1.5,  2. ]), array([2., 3.]))
    """

    stages: tuple[Affine | DeadZone, ...] = ()

    def __call__(self, x: Array) -> Array:
        """Give the values at x, shape (k,)."""
        for stage in self.stages:
            x = stage(x)
        return x

    @property
    def gain(self) -> float | None:
        """The gain of a line through 0, else None."""
        gain = 1.0
        for stage in self.stages:
            if not isinstance(stage, Affine) or stage.offset != 0.0:
                return None
            gain *= stage.gain
        return gain

    def inverse(self) -> PiecewiseMap:
        """Give the inverse map.

        Raises
        ------
        NotInvertibleError
            If a stage has none.
        """
        return PiecewiseMap(tuple(stage.exact_inverse() for stage in reversed(self.stages)))

    def slope(self, x: Array) -> Array:
        """Give the slopes at points that are no corners.

        Parameters
        ----------
        x
            Shape (k,), input units.

        Returns
        -------
        numpy.ndarray
            Shape (k,), output units per input unit.
        """
        slope = np.ones_like(x)
        for stage in self.stages:
            if isinstance(stage, Affine):
                slope = slope * stage.gain
            else:
                rho = stage.thresholds
                beyond = (rho == 0.0) | (x[:, None] * np.sign(rho) > np.abs(rho))
                slope = slope * (beyond @ stage.weights)
            x = stage(x)
        return slope

    def corners(self, low: float, high: float) -> Array:
        """Give the ends of an interval and all corners between them.

        Parameters
        ----------
        low, high
            The interval, input units.

        Returns
        -------
        numpy.ndarray
            Shape (k,), strictly ascending, from ``low`` to ``high``.
        """
        x = np.unique([low, high])
        for count, stage in enumerate(self.stages):
            if isinstance(stage, DeadZone):
                bends = stage.thresholds[stage.thresholds != 0.0]
                x = self._refined(x, count, bends)
        return x

    def largest_slope(self, reach: float) -> float:
        """Give the Lipschitz constant over ``-reach .. reach``.

        Parameters
        ----------
        reach
            Half the width of the interval, >= 0, input units.

        Returns
        -------
        float
        """
        x = self.corners(-reach, reach)
        middles = 0.5 * (x[1:] + x[:-1]) if x.size > 1 else x
        return float(np.abs(self.slope(middles)).max())

    def largest_value(self, reach: float) -> float:
        """Give the largest absolute value over ``-reach .. reach``.

        Parameters
        ----------
        reach
            Half the width of the interval, >= 0, input units.

        Returns
        -------
        float
        """
        return float(np.abs(self(self.corners(-reach, reach))).max())

    def _refined(self, x: Array, count: int, thresholds: Array) -> Array:
        """Corners of the first ``count`` stages, and where those stages give a threshold."""
        values = PiecewiseMap(self.stages[:count])(x)
        a, b = values[:-1, None], values[1:, None]
        with np.errstate(all="ignore"):
            share = (thresholds - a) / (b - a)
            inside = x[:-1, None] + share * np.diff(x)[:, None]
        return np.union1d(x, inside[(share > 0.0) & (share < 1.0)])


def largest_distance(
    first: PiecewiseMap, second: PiecewiseMap, reach: tuple[float, float], apart: float
) -> float:
    """Give the largest ``|first(x) - second(x')|`` over ``|x| <= reach[0]``, ``|x'| <= reach[1]``.

    The function is linear on the cells between corners, so its extremes over ``|x - x'| <= apart``
    lie where two corners meet, or where a corner meets the edge of that strip.

    Parameters
    ----------
    first, second
        The two maps.
    reach
        Largest amplitudes of the arguments, input units.
    apart
        How far the arguments may differ, >= 0, input units.

    Returns
    -------
    float

    Examples
    --------
    >>> largest_distance(PiecewiseMap(), PiecewiseMap((Affine(0.5),)), (2.0, 2.0), 0.0)
    1.0
    """
    x, other = first.corners(-reach[0], reach[0]), second.corners(-reach[1], reach[1])
    a, b = (each.ravel() for each in np.meshgrid(x, other))
    pairs = [(a, b)]
    for shift in (-apart, 0.0, apart):
        pairs += [(x, x + shift), (other + shift, other)]
    a, b = (np.concatenate(each) for each in zip(*pairs, strict=True))
    # A corner that touches the strip from outside by rounding is not lost.
    slack = 4.0 * np.finfo(np.float64).eps * (reach[0] + reach[1])
    allowed = (np.abs(a - b) <= apart + slack) & (np.abs(a) <= reach[0]) & (np.abs(b) <= reach[1])
    return float(np.abs(first(a[allowed]) - second(b[allowed])).max(initial=0.0))

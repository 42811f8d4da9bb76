"""Many plays of fixed radii beside an estimate: where the search for a better minimum starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine

Array = NDArray[np.float64]

_COUNT = 32
# From half the smallest radius to 2.2 times the largest: what a start that is 50 % off may need.
_BELOW, _ABOVE = 0.5, 2.2
_MOST_RATIO = 250.0
# Of the height of the loop. What noise there is is soon found; too much of it would smooth.
_NOISE = 0.01


@dataclass(frozen=True, eq=False)
class Cells:
    """Plays of fixed radii, in a geometric series.

    Parameters
    ----------
    radius
        Shape (M,), ascending, input units of the plays; M = 0 for no search.
    start, limit
        Shape (M + 2,), p0, weights and offset to start from, and their variances.
    noise
        Variance of the output to start from.
    """

    radius: Array
    start: Array
    limit: Array
    noise: float

    def hand_to(self, core: _engine.JointEstimation) -> None:
        """Tell the core of them."""
        start, limit = self.start.tolist(), self.limit.tolist()
        core.set_search(self.radius.tolist(), start, limit, self.noise)

    def memory_from(self, r: Array, z: Array) -> Array:
        """Give memories between those ``z`` of plays of radii ``r``."""
        return np.interp(self.radius, r, z)


def cells_for(theta: Array, plays: int, offset_variance: float, floor: float) -> Cells | None:
    """Give the cells for a search from a start, or None where its plays leave nothing to merge.

    Parameters
    ----------
    theta
        Shape (m,), the start.
    plays
        n.
    offset_variance
        Of the start's offset.
    floor
        Least variance of the noise.

    Returns
    -------
    Cells or None
        None without plays, with a negative weight (merging neighbours presumes that weights add
        up), or with radii of 0 alone.

    Examples
    --------
    >>> found = cells_for(np.array([1.0, 0.5, 2.0, 0.0]), 1, 1.0, 0.0)
    >>> found.radius[[0, -1]].round(2), found.start[[0, 1, -1]]
    (array([1. , 4.4]), array([1.      , 0.015625, 0.      ]))
    """
    p, r = theta[1 : plays + 1], theta[plays + 1 : 2 * plays + 1]
    if plays == 0 or (p < 0.0).any() or not p.sum() > 0.0 or r[-1] == 0.0:
        return None
    count = max(_COUNT, 2 * plays)
    top = _ABOVE * float(r[-1])
    bottom = max(_BELOW * float(r[0]), top / _MOST_RATIO)
    total = float(np.abs(theta[: plays + 1]).sum())
    weights = np.full(count, float(p.sum()) / count)
    limit = np.full(count + 2, total**2)
    limit[-1] = offset_variance
    noise = max((_NOISE * float(p @ r)) ** 2, floor)
    start = np.concatenate([theta[:1], weights, theta[2 * plays + 1 : 2 * plays + 2]])
    return Cells(np.geomspace(bottom, top, count), start, limit, noise)

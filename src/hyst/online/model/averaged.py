"""Derivatives averaged over what is not known: kinks of plays between samples are no edges then.

The output of a model of plays bends wherever a radius passes what samples reach. Its derivative at
one point promises more than the neighbourhood holds, and a quadratic made from it stays wrong when
the estimate has moved on. So what is kept of samples rests on the regression of the output over
the constants within their present uncertainty, and what that leaves unexplained counts as noise.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.online.model.window import Window

Array = NDArray[np.float64]

# Of the information: a standard error of half of what was believed.
_VAGUE = 4.0


@final
@dataclass(frozen=True, eq=False)
class Averaged:
    """``y = middle + columns (x - x_now)``, and what it misses.

    Parameters
    ----------
    middle
        Shape (N,).
    columns
        Shape (N, f).
    missed
        Shape (N,), variance.
    """

    middle: Array
    columns: Array
    missed: Array

    def first(self, count: int) -> Averaged:
        """Give that of the first samples."""
        return Averaged(self.middle[:count], self.columns[:count], self.missed[:count])

    def weights(self, weights: Array, variance: float) -> Array:
        """Give weights with what is missed counted as noise beside the ``variance`` there is."""
        return np.asarray(weights * (variance / (variance + self.missed)))


def averaged(
    window: Window,
    theta: Array,
    free: NDArray[np.intp],
    scale: Array,
    information: Array,
    limits: tuple[Array, Array],
    local: Array,
) -> Averaged | None:
    """Regress the window's output over the uncertainty of the constants.

    Parameters
    ----------
    window
        The samples.
    theta, free, scale
        The estimate, which constants are estimated, and their spreads: ``theta[free] = scale x``.
    information
        Shape (f, f), inverse covariance of x, at least 1 in each direction.
    limits
        Lower and upper bounds, shape (m,), at which points stop.
    local
        Shape (N, f), the derivative at the estimate, which counts along axes of which hardly
        anything is known: constants out of the drive's reach are not to be drawn into it.

    Returns
    -------
    Averaged or None
        None where an output is not finite.

    Notes
    -----
    Points at ``sqrt(f)`` standard errors along the axes of the covariance: Arasaratnam and Haykin,
    Cubature Kalman filters, IEEE Trans. Autom. Control 54 (2009) 1254-1269.
    """
    values, axes = np.linalg.eigh(information)
    errors = 1.0 / np.sqrt(np.maximum(values, 1.0))
    count = free.size
    pairs = np.empty((2, count, window.count))
    for k in range(count):
        if values[k] < _VAGUE:
            pairs[:, k] = window.outputs(theta)[0]
            continue
        for side, sign in enumerate((1.0, -1.0)):
            point = theta.copy()
            point[free] += sign * np.sqrt(count) * errors[k] * scale * axes[:, k]
            pairs[side, k] = window.outputs(np.clip(point, *limits))[0]
    if not np.isfinite(pairs).all():
        return None
    middle = pairs.mean(axis=(0, 1))
    slopes = (pairs[0] - pairs[1]) / (2.0 * np.sqrt(count))
    vague = values < _VAGUE
    slopes[vague] = (local @ axes[:, vague] * errors[vague]).T
    bends = pairs[0] + pairs[1] - 2.0 * middle
    columns = (slopes / errors[:, None]).T @ axes.T
    return Averaged(middle, columns, np.mean(bends**2, axis=0) / 4.0)

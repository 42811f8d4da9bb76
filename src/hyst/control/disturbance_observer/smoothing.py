"""A smooth stand-in for the norm, to get into the right valley before the exact one is descended.

``log(sum over a grid of frequencies of f^p) / p`` with f the square of the stacked gain tends to
the norm as p grows; with p small all of the curve pulls, and descents do not end at the first kink.
"""

from __future__ import annotations

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.control.disturbance_observer.stacked_gain import StackedGain

Array = NDArray[np.float64]

_LIGHTEST = 0.05  # least 2 zeta of a pair of poles: a sharper peak would fall between the grid's
_HEAVIEST = 1e3


def descend_smoothed(
    gain: StackedGain, start: Array, powers: tuple[float, ...] = (4.0, 20.0), steps: int = 40
) -> Array:
    """Minimize the sum of powers of the gain, one power after the other, and give the parameters.

    Parameters
    ----------
    gain
        The gain whose norm is to be minimized.
    start
        Parameters of stable poles.
    powers
        Ascending.
    steps
        At most so many for each.
    """
    at = gain.at(gain.grid.w[::2])
    from_damping, low, high = _damping_and_frequency(gain)
    z = np.clip(np.linalg.solve(from_damping, start), low, high)
    for power in powers:

        def cost(z: Array, power: float = power) -> tuple[float, Array]:
            values, slopes = gain.values_and_slopes(from_damping @ z, at)
            logarithms = np.log(values)
            top = float(logarithms.max())
            shares = np.exp(power * (logarithms - top))
            slope = (shares / values) @ slopes / shares.sum()
            return top + float(np.log(shares.sum())) / power, slope @ from_damping

        bounds = list(zip(low, high, strict=True))
        with np.errstate(all="ignore"):
            found = scipy.optimize.minimize(
                cost, z, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": steps}
            )
        if np.isfinite(found.x).all():
            z = found.x
    return gain.inside(from_damping @ z)


def _damping_and_frequency(gain: StackedGain) -> tuple[Array, Array, Array]:
    """Parameters as a linear function of log 2 zeta and log omega^2, and bounds of these."""
    pairs = 2 * (gain.order // 2)
    matrix, low, high = np.eye(gain.order), gain.lowest.copy(), gain.highest.copy()
    for i in range(0, pairs, 2):
        matrix[i, i + 1] = 0.5
    low[0:pairs:2], high[0:pairs:2] = np.log(_LIGHTEST), np.log(_HEAVIEST)
    return matrix, low, high

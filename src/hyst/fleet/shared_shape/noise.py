"""How noisy devices are, and how many of their samples count as one.

What the own best z of a device leaves is noise and what the shape lacks. Its variance is drawn to
that of the fleet as far as devices are alike in it, which few samples need; its correlation from
sample to sample is taken from all devices together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.special
from numpy.typing import NDArray

from hyst.fleet.shared_shape.device_equations import Equations

Array = NDArray[np.float64]

NOT_CORRELATED = 0.02
"""Autocorrelation of the whole fleet's remainder below which it is noise of the estimate."""

MOST_FREEDOM = 1e6
LEAST_FREEDOM = 2.0
NORMAL_QUARTILES = 1.349
"""Distance of the quartiles of a normal number of variance 1."""

SMALLEST_VARIANCE = 1e-24
"""Of the squared range: less is rounding."""


@dataclass(frozen=True)
class Noise:
    """Noise of a fleet, in units of the output's range.

    Parameters
    ----------
    variance
        Typical variance of what a device's own best z leaves.
    freedom
        As how many samples the fleet's variance counts beside those of a device.
    correlation
        Number of samples that count as one, at least 1.
    lacking
        Variance of the part of it that goes on from sample to sample: what the shape lacks.
    """

    variance: float
    freedom: float
    correlation: float
    lacking: float

    def of(self, equations: Equations) -> Array:
        """Give the variance of every device, for its samples as if they were independent.

        Parameters
        ----------
        equations
            Of devices.

        Returns
        -------
        numpy.ndarray
            Shape (devices,).
        """
        own = equations.freedom / self.correlation
        total = self.freedom * self.variance + equations.left / self.correlation
        variance = np.maximum(total / (self.freedom + own), SMALLEST_VARIANCE)
        return np.asarray(variance * self.correlation)

    def chance(self, equations: Equations) -> Array:
        """Give the probability that a device of the fleet leaves as much, shape (devices,)."""
        own = np.maximum(equations.freedom / self.correlation, 1.0)
        ratio = equations.left / np.maximum(equations.freedom, 1.0) / self.variance
        return np.asarray(scipy.special.fdtrc(own, self.freedom, ratio))


def noise_of(equations: Equations) -> Noise:
    """Estimate the noise of a fleet from its middle devices.

    Parameters
    ----------
    equations
        Of its devices.

    Notes
    -----
    Variances that scatter as ``s^2 F(d, f)`` have logarithms of variance ``trigamma(d / 2) +
    trigamma(f / 2)``: G. K. Smyth, Stat. Appl. Genet. Mol. Biol. 3 (2004), 3; here by quartiles,
    so that a few devices of another kind do not count.
    """
    known = equations.freedom > 0.0
    if not known.any():
        return Noise(SMALLEST_VARIANCE, MOST_FREEDOM, 1.0, 0.0)
    freedom = equations.freedom[known]
    own = np.maximum(equations.left[known] / freedom, SMALLEST_VARIANCE)
    middle = own <= 4.0 * np.median(own)
    shape = np.sum(equations.lagged[known][middle] / own[middle, None], axis=0)
    shape = shape / shape[0]
    below = np.flatnonzero(shape[1:] < NOT_CORRELATED)
    stop = int(below[0]) + 1 if below.size else shape.size
    correlation = max(1.0 + 2.0 * float(shape[1:stop].sum()), 1.0)
    logs = np.log(own)
    spread = float(np.subtract(*np.quantile(logs, [0.75, 0.25]))) / NORMAL_QUARTILES
    by_chance = scipy.special.polygamma(1, np.maximum(freedom / correlation, 1.0) / 2.0)
    beyond = spread**2 - float(np.median(by_chance))
    typical = float(np.exp(np.median(logs)))
    lacking = typical * float(max(shape[1], 0.0)) if stop > 1 else 0.0
    return Noise(typical, _freedom_of(beyond), correlation, lacking)


def _freedom_of(variance: float) -> float:
    """Give f with ``trigamma(f / 2) = variance``, within limits."""
    if variance <= scipy.special.polygamma(1, MOST_FREEDOM / 2.0):
        return MOST_FREEDOM
    # Newton's method for 1 / trigamma, which is nearly a straight line.
    half = 0.5 + 1.0 / variance
    for _ in range(30):
        value = float(scipy.special.polygamma(1, half))
        half += value * (1.0 - value / variance) / float(scipy.special.polygamma(2, half))
        half = max(half, 1e-3)
    return float(np.clip(2.0 * half, LEAST_FREEDOM, MOST_FREEDOM))

"""The actuator of the study of S3: Bouc-Wen's equation, asymmetry, a resonance and creep."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.signal import cont2discrete, lfilter

Array = NDArray[np.float64]

DT = 5e-4
SCATTER = 0.0019
"""Of a measured piezo from cycle to cycle, rms over its stroke: the noise of the simulated one."""

SLOPE = 8.2
"""d of y = d u - z, nm/V."""
RISE, HOLD, RELEASE = 4.0, 0.006, 0.002
"""A, nm/V, beta and gamma, 1/V, of dz = (A - beta sgn(du) z - gamma |z|) du."""
BEND = 6e-4
"""Of the asymmetric one: e of y = d u + e u^2 - z, nm/V^2."""
RESONANCE, DAMPING = 2000.0, 0.05
"""Of the stage, Hz."""
CREEP, LAGS = 0.015, (0.05, 0.5, 5.0)
"""Share of the position that each lag, seconds, adds with time."""

_FINE = 20
"""Steps in a sample: between two of them the amplifier's voltage is a straight line."""


@final
@dataclass(frozen=True)
class SimulatedPiezo:
    """A piezo that is none of the models, simulated by its own differential equations.

    ``y = d u + e u^2 - z`` with Bouc-Wen's z, plus three lags of it that creep, seen through a
    resonance. Volts in, nanometres out, some 3.2 um at 500 V.

    Parameters
    ----------
    asymmetric
        Whether e is not 0: rising and falling branches are then no images of each other.
    creeps
        Whether the position goes on after the voltage rests.
    noise_seed
        Of the sensor.
    """

    asymmetric: bool = True
    creeps: bool = True
    noise_seed: int = 0

    def __call__(self, u: Array) -> Array:
        """Give the position, from rest at 0 V.

        Parameters
        ----------
        u
            Volts, one every ``DT``, reached from the one before along a straight line.

        Returns
        -------
        numpy.ndarray
        """
        ends = np.concatenate([[0.0], u])
        fine = np.interp(np.arange(u.size * _FINE + 1) / _FINE, np.arange(ends.size), ends)
        y = SLOPE * fine - _hysteresis(fine)
        if self.asymmetric:
            y = y + BEND * fine**2
        if self.creeps:
            y = y + sum(CREEP * _lagged(y, lag) for lag in LAGS)
        return np.asarray(_resonating(y)[_FINE::_FINE])

    def measure(self, u: Array) -> Array:
        """Give the position with the sensor's noise.

        Parameters
        ----------
        u
            Volts.

        Returns
        -------
        numpy.ndarray
        """
        y = self(u)
        noise = np.random.default_rng(self.noise_seed).normal(size=y.size)
        return np.asarray(y + SCATTER * np.ptp(y) * noise)


def _hysteresis(u: Array) -> Array:
    """Integrate z over u by the method of Runge and Kutta of order 4, a step a fine sample."""
    z, found = 0.0, [0.0]
    for du in np.diff(u).tolist():
        s = 1.0 if du > 0.0 else -1.0
        first = (RISE - HOLD * s * z - RELEASE * abs(z)) * du
        second = _increment(z + 0.5 * first, s, du)
        third = _increment(z + 0.5 * second, s, du)
        z += (first + 2.0 * second + 2.0 * third + _increment(z + third, s, du)) / 6.0
        found.append(z)
    return np.array(found)


def _increment(z: float, s: float, du: float) -> float:
    return (RISE - HOLD * s * z - RELEASE * abs(z)) * du


def _lagged(y: Array, lag: float) -> Array:
    """Give a first-order lag, exact for an input that rests between fine samples."""
    stay = np.exp(-DT / _FINE / lag)
    return np.asarray(lfilter([0.0, 1.0 - stay], [1.0, -stay], y))


def _resonating(y: Array) -> Array:
    """Give the stage's answer, exact for a force that is straight between fine samples."""
    w = 2.0 * np.pi * RESONANCE
    system = ([w * w], [1.0, 2.0 * DAMPING * w, w * w])
    numerator, denominator, _ = cont2discrete(system, DT / _FINE, method="foh")
    return np.asarray(lfilter(numerator[0], denominator, y))

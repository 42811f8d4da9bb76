"""A stage that creeps behind its hysteresis and lags before it, in fine steps of time.

Independent of the kinds it is a plant for: lag and creep are differential equations solved by the
trapezoidal rule at a hundred steps a sample.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter, lfiltic

import hyst

Array = NDArray[np.float64]

STEPS = 100
"""Of time in a sample."""


@dataclass(frozen=True)
class CreepingActuator:
    """Amplifier with a lag, plays, a map after them, creep, and noise of the sensor.

    Parameters
    ----------
    weights, time_constants
        Of the creep: shares of the stroke, and s.
    lag
        Time constant of the amplifier, s; 0 for none.
    dt
        Sample time, s.
    offset
        Of the sensor, um.
    """

    weights: tuple[float, ...] = (0.02, 0.02, 0.02)
    time_constants: tuple[float, ...] = (0.37, 3.1, 23.0)
    lag: float = 0.42 * 0.005
    dt: float = 0.005
    offset: float = 1.5

    @property
    def hysteresis(self) -> hyst.Operator:
        """The modified Prandtl-Ishlinskii model: V to um."""
        plays = hyst.PrandtlIshlinskii([0.09, 0.07, 0.05, 0.04], [4.0, 11.0, 23.0, 38.0], 0.35)
        bend = hyst.DeadZone([1.0, -0.12, 0.10], [0.0, 14.0, 34.0])
        return hyst.ModifiedPrandtlIshlinskii(plays, bend)

    def output(self, u: Array, noise: float = 0.0, seed: int = 0) -> Array:
        """Give the output at every sample of a drive that is a line between samples.

        Parameters
        ----------
        u
            Shape (N,), V; the actuator has rested at 0 V before.
        noise
            Rms, um.
        seed
            Of the noise.
        """
        step = self.dt / STEPS
        samples = np.arange(u.size)
        fine = np.interp(np.arange(STEPS * (u.size - 1) + 1) / STEPS, samples, u)
        moved = self.hysteresis(lagged(fine, self.lag, step, fine[0]))
        crept = moved.copy()
        for weight, tau in zip(self.weights, self.time_constants, strict=True):
            crept += weight * lagged(moved, tau, step, 0.0)
        y = crept[::STEPS] + self.offset
        return np.asarray(y + noise * np.random.default_rng(seed).standard_normal(y.size))


def lagged(u: Array, tau: float, step: float, rest: float) -> Array:
    """Solve ``tau x' = u - x`` from rest by the trapezoidal rule.

    Parameters
    ----------
    u
        Shape (N,), input at every step.
    tau
        Time constant, s; 0 gives the input.
    step
        Of time, s.
    rest
        The level the input has had before.
    """
    if tau == 0.0:
        return u
    b, a = [step, step], [2.0 * tau + step, step - 2.0 * tau]
    return np.asarray(lfilter(b, a, u, zi=lfiltic(b, a, [rest], [rest]))[0])


def record_of_a_lab(duration: float = 100.0, dt: float = 0.005, top: float = 100.0) -> Array:
    """Give a drive as a lab would record: strokes of many amplitudes at several levels, and holds.

    Parameters
    ----------
    duration
        s.
    dt
        Sample time, s.
    top
        Of the range, which begins at 0.
    """
    corners = [(0.0, 0.0), (1.0, 0.0)]
    for level in (1.0, 0.0, 0.9, 0.1, 0.75, 0.2, 0.6, 0.3, 0.5):
        corners.append((corners[-1][0] + 0.8, level))
    for level, hold in ((0.9, 12.0), (0.3, 8.0), (0.6, 3.0), (0.1, 5.0), (1.0, 6.0), (0.0, 8.0)):
        corners.append((corners[-1][0] + 0.5, level))
        corners.append((corners[-1][0] + hold, level))
        for way in (-0.3, 0.25, -0.2, 0.15) if level > 0.5 else (0.3, -0.25, 0.2, -0.15):
            end = min(max(level + way, 0.0), 1.0)
            corners.append((corners[-1][0] + 0.6, end))
    for level in (1.0, 0.0, 0.8, 0.2, 0.9, 0.4, 0.7, 0.0):
        corners.append((corners[-1][0] + 1.5, level))
    times, levels = np.array(corners).T
    times = times * duration / times[-1]
    return np.asarray(top * np.interp(np.arange(round(duration / dt)) * dt, times, levels))

"""How sure a drive's own lines near a resonance make it, without what hysteresis adds to them.

Simulated hysteresis of few plays has corners, which excite resonances far above the drive, and a
stated order lets frequencies far below tell of them; actuators keep to neither. So resonances are
also judged by the lines near them alone, behind a gain of any size and phase.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complexes = NDArray[np.complex128]

_NEAR_RESONANCE = 1.5  # times and part of its frequency
_NEAR_LAG = 3.0
_NOTHING = 1e-10  # of the largest line, rounding


@dataclass(frozen=True, eq=False)
class OwnLines:
    """Lines of a drive behind its hysteresis, as far as that is a gain.

    Parameters
    ----------
    frequency
        Shape (m,), Hz.
    lines
        Shape (m,), complex, times the gain.
    noise
        Of the real or the imaginary part of a line.
    """

    frequency: Array
    lines: Complexes
    noise: float

    @classmethod
    def of(cls, u: Array, dt: float, gain: float, noise: float, period: int) -> OwnLines:
        """Give the lines of a drive.

        Parameters
        ----------
        u
            Shape (N,).
        dt
            Sample time, s.
        gain
            Of the hysteresis.
        noise
            Standard deviation of white noise of the output.
        period
            Samples of a period, 0 if there is none.
        """
        # A drive that ends elsewhere than it began has no lines where its jump would put them.
        repeats = period > 0 and u.size % period == 0
        window = np.ones(u.size) if repeats else np.hanning(u.size)
        window = np.asarray(window / math.sqrt(float(np.mean(window**2))), dtype=np.float64)
        lines = gain * np.fft.rfft(window * (u - u.mean()))
        lines[np.abs(lines) <= _NOTHING * np.abs(lines).max(initial=0.0)] = 0.0
        each = noise * math.sqrt(0.5 * u.size)
        frequency = np.asarray(np.fft.rfftfreq(u.size, dt), dtype=np.float64)
        return cls(frequency, lines, each)

    def shares(self, pole: complex, size_there: float) -> tuple[float, float]:
        """Give standard errors of frequency and damping as shares of them, infinite if unknown.

        Parameters
        ----------
        pole
            Continuous, rad/s; with an imaginary part it stands for a pair.
        size_there
            Gain of the dynamics at its frequency.
        """
        w0 = abs(pole)
        resonant = pole.imag != 0.0
        reach = _NEAR_RESONANCE if resonant else _NEAR_LAG
        w = 2.0 * math.pi * self.frequency
        near = (w >= w0 / reach) & (w <= w0 * reach) & (self.lines != 0.0)
        if not near.any():
            return math.inf, math.inf
        response, slopes = _response(1j * w[near] / w0, -pole.real / w0, resonant)
        peak = abs(_response(np.array([1j]), -pole.real / w0, resonant)[0][0])
        gain = size_there / peak * self.lines[near]
        columns = [gain * each for each in (*slopes, response, 1j * response)]
        stacked = np.array([np.concatenate([c.real, c.imag]) for c in columns]).T / self.noise
        errors = _errors(stacked)
        return (float(errors[0]), float(errors[1])) if resonant else (float(errors[0]), 0.0)


def _response(s: Complexes, damping: float, resonant: bool) -> tuple[Complexes, list[Complexes]]:
    """Give the response at s in units of w0, and its slopes by the logarithms of w0 and damping."""
    if not resonant:
        lag = 1.0 / (1.0 + s)
        return lag, [s * lag**2]
    below = s**2 + 2.0 * damping * s + 1.0
    return 1.0 / below, [
        (2.0 * s**2 + 2.0 * damping * s) / below**2,
        -2.0 * damping * s / below**2,
    ]


def _errors(columns: Array) -> Array:
    """Give standard errors of all coefficients of unit noise, infinite where they are open."""
    if len(columns) < columns.shape[1]:
        return np.full(columns.shape[1], math.inf)
    size = np.linalg.norm(columns, axis=0)
    _, values, directions = np.linalg.svd(columns / size, full_matrices=False)
    if values[-1] <= 1e-9 * values[0]:
        return np.full(columns.shape[1], math.inf)
    return np.asarray(np.linalg.norm(directions.T / values, axis=1) / size)

"""A stage to learn on: Bouc-Wen hysteresis, creep and a mode behind it, noise of its sensor.

    dz/du = A - |z| (beta sgn(z du) + gamma),   x = k u + h z
    c_i' = (x - c_i) / tau_i,   w = x + sum_i share_i c_i
    y'' + 2 zeta omega y' + omega^2 y = omega^2 w

The drive is a line between samples. z is exact on every line; creep and mode are exact for signals
that are lines between points four a sample. Nothing of hyst is in here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm
from scipy.signal import lfilter

Array = NDArray[np.float64]

POINTS = 4
"""Of time in a sample."""


@dataclass
class LearningStage:
    """0 to 100 V in, about 0 to 64 um out.

    Parameters
    ----------
    dt
        Sample time, s.
    mode, damping
        Hz, and of critical; 0 Hz for no mode.
    creep
        Pairs of share of the stroke and time constant, s.
    delay
        Of the sensor, whole samples.
    noise
        Rms of the sensor, um.
    gain
        Of everything; to be changed while it runs.
    passed
        Drives passed before the stage came to rest at the first drive, V; every motion begins so.
    seed
        Of the noise.
    """

    dt: float = 1e-4
    mode: float = 800.0
    damping: float = 0.05
    creep: tuple[tuple[float, float], ...] = ((0.015, 0.05), (0.015, 0.6), (0.015, 7.0))
    delay: int = 0
    noise: float = 0.0
    gain: float = 1.0
    passed: tuple[float, ...] = (0.0, 100.0, 0.0)
    seed: int = 0
    k: float = 0.8
    a: float = 0.35
    beta: float = 0.025
    gamma: float = -0.005
    h: float = -1.0
    _draws: np.random.Generator = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._draws = np.random.default_rng(self.seed)

    def measured(self, u: ArrayLike) -> Array:
        """Give what the sensor reads, shape (N,), for a drive from rest, shape (N,), V."""
        y = self.moved(u)
        return np.asarray(y + self.noise * self._draws.standard_normal(y.size))

    def moved(self, u: ArrayLike) -> Array:
        """Give the position itself, shape (N,), um."""
        drive = np.asarray(u, dtype=np.float64)
        at = np.arange(POINTS * (drive.size - 1) + 1) / POINTS
        fine = np.interp(at, np.arange(drive.size), drive)
        before = np.array([*self.passed, fine[0]])
        z = self._memory(np.concatenate([before, fine]))[before.size :]
        x = self.gain * (self.k * fine + self.h * z)
        step = self.dt / POINTS
        crept = x - x[0]
        for share, tau in self.creep:
            crept = crept + share * _lagged(x - x[0], tau, step)
        y = x[0] + (crept if self.mode == 0.0 else self._shaken(crept, step))[::POINTS]
        return np.concatenate([np.full(self.delay, y[0]), y])[: drive.size]

    def _memory(self, u: Array) -> Array:
        """Solve for z along lines: of either sign of z the equation is linear in u."""
        z, found = 0.0, [0.0]
        for change in np.diff(u).tolist():
            z = self._along(z, change)
            found.append(z)
        return np.array(found)

    def _along(self, z: float, change: float) -> float:
        for _ in range(2):  # at most one change of sign on a line
            if change == 0.0:
                break
            up = z > 0.0 or (z == 0.0 and change > 0.0)
            sense = math.copysign(1.0, change) * (1.0 if up else -1.0)
            rate = (self.beta * sense + self.gamma) * (1.0 if up else -1.0)
            end = self._level(z, rate, change)
            if z == 0.0 or end == 0.0 or (end > 0.0) == (z > 0.0):
                return end
            # dz/du = a - rate z from z to 0.
            part = math.log1p(-rate * z / self.a) / rate if rate else -z / self.a
            z, change = 0.0, change - part
        return z

    def _level(self, z: float, rate: float, change: float) -> float:
        if rate == 0.0:
            return z + self.a * change
        return z * math.exp(-rate * change) - self.a * math.expm1(-rate * change) / rate

    def _shaken(self, w: Array, step: float) -> Array:
        omega = 2.0 * math.pi * self.mode
        a = np.array([[0.0, 1.0], [-(omega**2), -2.0 * self.damping * omega]])
        b, c = np.array([[0.0], [omega**2]]), np.array([[1.0, 0.0]])
        return _on_lines(a, b, c, w, step)


def _lagged(x: Array, tau: float, step: float) -> Array:
    return _on_lines(np.array([[-1 / tau]]), np.array([[1 / tau]]), np.array([[1.0]]), x, step)


def _on_lines(a: Array, b: Array, c: Array, w: Array, step: float) -> Array:
    """Solve ``x' = a x + b w, y = c x`` from rest for w that is a line between points, exactly."""
    n = a.shape[0]
    whole = np.zeros((n + 2, n + 2))
    whole[:n, :n], whole[:n, n : n + 1], whole[n, n + 1] = a * step, b * step, 1.0
    moved = expm(whole)
    phi, first, then = moved[:n, :n], moved[:n, n], moved[:n, n + 1]
    # x[k+1] = phi x[k] + (first - then) w[k] + then w[k+1]; to one recursion of the output.
    poles = np.poly(phi)
    # w[0] is 0; a pulse moves x by `then` as it comes and by `first - then` a step later.
    response, x = [], then
    for k in range(n + 1):
        response.append(float((c @ x)[0]))
        x = phi @ x + ((first - then) if k == 0 else 0.0)
    zeros = np.convolve(poles, response)[: n + 1]
    return np.asarray(lfilter(zeros, poles, w))

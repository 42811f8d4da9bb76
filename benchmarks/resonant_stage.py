"""A stage of no model's class: Bouc-Wen hysteresis with a mode behind it, in fine steps.

    dz/dt = (A - |z| (beta sgn(z du/dt) + gamma)) du/dt,   v = k u + h z
    d2y/dt2 + 2 zeta w dy/dt + w^2 y = w^2 v

The drive is a line between samples. Nothing of hyst is in here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]

RATE = 8000.0
"""Samples a second: ten of a period of the mode, a hundred of one at 80 Hz."""

K, A, BETA, GAMMA, H = 0.6, 0.12, 0.012, 0.006, -1.0
"""Of a piezo: V in, um out; 0 to 100 V are 48 um, with a loop of a sixth of them."""

MODE, DAMPING = 2.0 * math.pi * 800.0, 0.05

STEPS = 16
"""Of the fourth order from sample to sample; see ``largest_error``."""


def stage(u: ArrayLike) -> Array:
    """Give the position at every sample, from rest at the first drive with z = 0.

    Parameters
    ----------
    u
        Drive, V, shape (N,), 8000 samples a second.

    Returns
    -------
    Array
        Position, um, shape (N,).
    """
    drive = np.asarray(u, dtype=np.float64)
    step = 1.0 / (RATE * STEPS)
    at = (float(H * 0.0 + K * drive[0]), 0.0, 0.0)
    found = [at[0]]
    for last, change in zip(drive[:-1].tolist(), np.diff(drive).tolist(), strict=True):
        for part in range(STEPS):
            at = _stepped(at, last + change * part / STEPS, change * RATE, step)
        found.append(at[0])
    return np.array(found)


def _slope(at: tuple[float, float, float], u: float, speed: float) -> tuple[float, float, float]:
    """Of position, velocity and z."""
    y, velocity, z = at
    dz = (A - abs(z) * (BETA * math.copysign(1.0, z * speed) + GAMMA)) * speed
    return velocity, MODE * (MODE * (K * u + H * z - y) - 2.0 * DAMPING * velocity), dz


def _stepped(
    at: tuple[float, float, float], u: float, speed: float, step: float
) -> tuple[float, float, float]:
    """One step of the classical method of fourth order."""
    half = 0.5 * step
    a = _slope(at, u, speed)
    b = _slope(_moved(at, a, half), u + speed * half, speed)
    c = _slope(_moved(at, b, half), u + speed * half, speed)
    d = _slope(_moved(at, c, step), u + speed * step, speed)
    mean = tuple((p + 2.0 * (q + r) + s) / 6.0 for p, q, r, s in zip(a, b, c, d, strict=True))
    return _moved(at, mean, step)


def _moved(
    at: tuple[float, float, float], slope: Sequence[float], step: float
) -> tuple[float, float, float]:
    return at[0] + step * slope[0], at[1] + step * slope[1], at[2] + step * slope[2]


def largest_error(u: ArrayLike) -> float:
    """Give how far fine steps are from Radau's method at 1e-11, um, over a short drive."""
    drive = np.asarray(u, dtype=np.float64)
    at, found = np.array([K * drive[0], 0.0, 0.0]), [K * float(drive[0])]
    for last, change in zip(drive[:-1].tolist(), np.diff(drive).tolist(), strict=True):
        speed = change * RATE

        def slope(t: float, at: Array, last: float = last, speed: float = speed) -> Array:
            y, velocity, z = at.tolist()
            return np.array(_slope((y, velocity, z), last + speed * t, speed))

        at = solve_ivp(slope, (0.0, 1.0 / RATE), at, method="Radau", rtol=1e-11, atol=1e-11).y[
            :, -1
        ]
        found.append(float(at[0]))
    return float(np.abs(stage(drive) - found).max())

"""Simulated actuators and drives for the tests of diagnosis, independent of hyst's models."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]
Actuator = Callable[[Array], Array]

DT = 1e-3


def plays(u: Array, p0: float = 0.5, weights: tuple[float, ...] = (0.1, 0.06, 0.03)) -> Array:
    """Line and three plays of 4, 15 and 30 V, started without memory."""
    y = p0 * u
    for weight, radius in zip(weights, (4.0, 15.0, 30.0), strict=True):
        y = y + weight * play(u, radius)
    return y


def play(u: Array, radius: float) -> Array:
    """One play, sample by sample."""
    z, result = 0.0, []
    for value in u.tolist():
        z = max(value - radius, min(value + radius, z))
        result.append(z)
    return np.array(result)


def bent(u: Array) -> Array:
    """Plays and a curve behind them: not symmetric."""
    y = plays(u)
    return y + 0.002 * y**2


def switching(u: Array) -> Array:
    """Relays of normally distributed thresholds: a smooth Preisach model of wide loops."""
    scale = float(np.abs(u - u.mean()).max())
    middle = float(u.mean())
    y = np.zeros_like(u)
    for width in np.linspace(0.15, 0.75, 7):
        for centre in np.linspace(-0.3, 0.3, 5):
            y += _relay((u - middle) / scale - centre, width)
    return 10.0 * y / 35.0 + 0.05 * (u - middle)


def friction(u: Array) -> Array:
    """Spring and Dahl friction with an exponential approach: stop-like, run clockwise."""
    force, limit, stiffness = 0.0, 8.0, 1.5
    result = [force]
    for step in np.diff(u).tolist():
        side = 1.0 if step > 0.0 else -1.0
        force = side * limit + (force - side * limit) * np.exp(-stiffness * abs(step) / limit)
        result.append(force)
    return np.array(result) + 0.02 * u


def _relay(u: Array, width: float) -> Array:
    state, result = -1.0, []
    for value in u.tolist():
        if value > width:
            state = 1.0
        elif value < -width:
            state = -1.0
        result.append(state)
    return np.array(result)


def triangle(period: float = 500.0, samples: int = 4000, low: float = 0.0, high: float = 100.0):
    """Start at ``low`` and go up; the period need not be whole."""
    phase = (np.arange(samples) / period) % 1.0
    return low + (high - low) * (1.0 - np.abs(2.0 * phase - 1.0))


def sine(period: float = 500.0, samples: int = 4000, low: float = 0.0, high: float = 100.0):
    """Start at ``low`` and go up."""
    phase = np.arange(samples) / period
    return low + 0.5 * (high - low) * (1.0 - np.cos(2.0 * np.pi * phase))


def through(levels: list[float], per_branch: int = 250) -> Array:
    """Straight from level to level, as many samples each."""
    parts = [np.linspace(one, two, per_branch, endpoint=False) for one, two in pairwise(levels)]
    return np.concatenate([*parts, levels[-1:]])


NESTED = [0.0, 100, 0, 100, 0, 80, 0, 60, 0, 100, 0, 40, 0, 20, 0, 100, 0]


def record(
    u: Array,
    y: Array,
    noise: float = 0.0,
    seed: int = 0,
    dt: float = DT,
    input_unit: str = "V",
    output_unit: str = "um",
) -> hyst.Record:
    """Record with white noise on the output, rms in its units."""
    added = noise * np.random.default_rng(seed).standard_normal(u.size)
    return hyst.Record(u, y + added, dt, input_unit=input_unit, output_unit=output_unit)


def warned(records: hyst.Record | list[hyst.Record]) -> set[str]:
    """Names of what a diagnosis warns of, but for one amplitude."""
    found = hyst.diagnose(records).findings
    return {each.name for each in found if each.severity != "remark"} - {"amplitudes"}

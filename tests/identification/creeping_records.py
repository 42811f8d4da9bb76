"""Records of a plant that creeps, drifts or warms up, by differential equations in fine steps."""

from __future__ import annotations

import numpy as np
from benchmarks.creeping_actuator import lagged
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]

DT, STEPS = 0.05, 20
PLAYS = hyst.PrandtlIshlinskii([0.5, 0.3], [0.15, 0.4], 1.0)


def drive(dt: float = DT, seed: int = 0) -> Array:
    """Give strokes of several lengths and holds at several levels, 120 s from rest at 0."""
    rng = np.random.default_rng(seed)
    times, levels = [0.0, 1.0], [0.0, 0.0]
    for level in (1.0, -1.0, 0.8, -0.6, 0.5):
        times.append(times[-1] + 2.0)
        levels.append(level * rng.uniform(0.9, 1.0))
    for level, hold in ((0.9, 22.0), (-0.7, 14.0), (0.2, 6.0), (-0.2, 3.0), (0.6, 12.0)):
        times += [times[-1] + 1.0, times[-1] + 1.0 + hold]
        levels += [level, level]
        for way in (0.4, -0.5, 0.3):
            times.append(times[-1] + 1.5)
            levels.append(float(np.clip(level + way * rng.uniform(0.8, 1.2), -1.0, 1.0)))
    for level in (1.0, -1.0, 0.4, -0.3, 0.0):
        times.append(times[-1] + 2.0)
        levels.append(level)
    scaled = np.array(times) * 120.0 / times[-1]
    return np.asarray(np.interp(np.arange(round(120.0 / dt)) * dt, scaled, levels))


def crept(
    u: Array,
    weights: tuple[float, ...] = (),
    tau: tuple[float, ...] = (),
    dt: float = DT,
    plant: hyst.Operator = PLAYS,
) -> Array:
    """Give the output of a plant behind which lags of time constants tau, s, add to its output.

    The drive is a line between samples; lags are solved by the trapezoidal rule in fine steps.
    """
    fine = np.interp(np.arange(STEPS * (u.size - 1) + 1) / STEPS, np.arange(u.size), u)
    moved = plant(fine)
    total = moved.copy()
    for weight, time in zip(weights, tau, strict=True):
        total += weight * lagged(moved, time, dt / STEPS, 0.0)
    return np.asarray(total[::STEPS])


def record(y: Array, u: Array, seed: int, noise: float = 2e-3, dt: float = DT) -> hyst.Record:
    """Give a record with white noise of some share of the output's range."""
    rough = noise * np.ptp(y) * np.random.default_rng(seed).standard_normal(y.size)
    return hyst.Record(u, y + rough, dt)

"""The five plays of S2 sec. IV, and what they give for its inputs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]

P = np.array([0.3, 0.5, 0.8, 0.3, 0.2])
R = np.array([0.4, 1.0, 1.5, 2.0, 3.6])
DT = 1e-3
FIVE_PLAYS = hyst.PrandtlIshlinskii(P, R)


def sine(seconds: float, dt: float = DT) -> Array:
    return 30.0 * np.sin(2.0 * np.pi * np.arange(round(seconds / dt) + 1) * dt)


def regimes_of(u: Array, r: Array) -> Array:
    """Count plays of radii r on the envelope the input moves along, eqs. 1 and 2; NaN at rest."""
    z, before, found = np.zeros(r.size), u[0], np.full(u.size, np.nan)
    for k, v in enumerate(u):
        z = np.maximum(v - r, np.minimum(v + r, z))
        if v != before:
            found[k] = np.sum(np.sign(v - before) * (v - z) >= r - 1e-9)
        before = v
    return found


def record(u: Array, y: Array, dt: float = DT) -> hyst.Record:
    return hyst.Record(u, y, dt)


def random_signals(rng: np.random.Generator, samples: int) -> tuple[Array, Array]:
    """Noise, then in blocks of 1000: rest, a stuck output, jumps, a random walk against its output,
    numbers beyond all measure, NaN and infinities, both at rest."""
    u, y = rng.normal(0.0, 10.0, samples), rng.normal(0.0, 20.0, samples)
    for first in range(0, samples, 1000):
        block, kind = slice(first, first + 1000), first // 1000 % 9
        steps = np.arange(1000)
        if kind == 1:
            u[block] = rng.normal(0.0, 5.0)
        elif kind == 2:
            y[block] = rng.normal(0.0, 5.0)
        elif kind == 3:
            u[block] = np.where(steps % 200 < 100, 30.0, -30.0)
        elif kind == 4:
            u[block] = np.cumsum(u[block])
            y[block] = -3.0 * u[block]
        elif kind == 5:
            y[block][::100], u[block][::37] = 1e300, -1e200
        elif kind == 6:
            y[block][rng.random(1000) < 0.05] = np.nan
            u[block][rng.random(1000) < 0.05] = -np.inf
        elif kind == 7:
            u[block], y[block] = 1.0, -2.0
    return u, y


def usable(u: Array, y: Array) -> NDArray[np.bool_]:
    """Finite, and far from numbers whose squares overflow."""
    return (np.abs(u) < 1e100) & (np.abs(y) < 1e100)

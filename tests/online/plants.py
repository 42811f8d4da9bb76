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


def record(u: Array, y: Array, dt: float = DT) -> hyst.Record:
    return hyst.Record(u, y, dt)

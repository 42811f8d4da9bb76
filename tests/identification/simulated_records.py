"""Simulated records shared by the tests of identification."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst

TRUE_PI = hyst.PrandtlIshlinskii(p=[0.5, 0.4, 0.3], r=[0.1, 0.3, 0.6], p0=1.0)


def drive(samples: int = 3000, seed: int = 7) -> NDArray[np.float64]:
    """Give a smooth random-phase multisine with peak 1: major and minor loops of all sizes."""
    t = np.arange(samples)
    phases = np.random.default_rng(seed).uniform(0.0, 2 * np.pi, 12)
    waves = np.sin(2 * np.pi * np.outer(t, np.arange(1, 13)) * 2 / samples + phases).sum(axis=1)
    return np.asarray(waves / np.abs(waves).max())


def record(
    model: hyst.Operator,
    u: NDArray[np.float64] | None = None,
    noise: float = 0.0,
    delay: int = 0,
    seed: int = 0,
) -> hyst.Record:
    """Give a record of a model with white noise and a delayed output."""
    u = drive() if u is None else u
    y = model(u)
    y = np.concatenate([np.full(delay, y[0]), y])[: u.size]
    return hyst.Record(u, y + noise * np.random.default_rng(seed).standard_normal(u.size), dt=1e-3)


def plays_by_definition(u: NDArray[np.float64], r: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give play outputs sample by sample from S1 eq. 2."""
    z = np.zeros(r.size)
    rows = []
    for sample in u:
        z = np.maximum(sample - r, np.minimum(sample + r, z))
        rows.append(z)
    return np.array(rows)

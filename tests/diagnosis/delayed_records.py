"""Records with a delay that is known, of plants that are plays and of plants that are none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]

RATE = 200
FINE = 5
SETTLED = 150


def drive(shape: str, decay: float = 0.0, rate: float = RATE, frequency: float = 1.0) -> Array:
    """Give eight periods whose amplitude falls from 1 by ``decay``."""
    t = np.arange(round(8 * rate / frequency)) / rate
    wave = np.sin(2.0 * np.pi * frequency * t)
    wave = wave if shape == "sine" else 2.0 / np.pi * np.arcsin(wave)
    return np.asarray((1.0 - decay * t / t[-1]) * wave)


def plays(seed: int, kind: str = "pi") -> Callable[[Array], Array]:
    """Give four random plays, alone, below dead zones ("mpi") or below a cubic."""
    rng = np.random.default_rng(seed)
    p, r = 0.3 * rng.exponential(size=4), np.sort(rng.uniform(0.03, 0.8, 4))
    bank = hyst.PrandtlIshlinskii(p, r, float(rng.uniform(0.3, 1.0)))
    if kind == "pi":
        return bank
    if kind == "mpi":
        top = float(bank(np.array([1.0]))[0])
        weights = np.concatenate([[1.0], rng.uniform(-0.2, 0.4, 4)])
        bends = top * np.array([0.0, -0.6, -0.3, 0.3, 0.6])
        return hyst.ModifiedPrandtlIshlinskii(bank, hyst.DeadZone(weights, bends))

    def cubic(u: Array) -> Array:
        v = bank(u)
        return np.asarray(v + 0.6 * (v**2 - 0.3 * v**3) / np.ptp(v))

    return cubic


def noisy(u: Array, y: Array, noise: float, seed: int = 0, dt: float = 1.0 / RATE) -> hyst.Record:
    """Add white noise of a part of the output's range."""
    scatter = noise * float(np.ptp(y)) * np.random.default_rng(1000 + seed).standard_normal(u.size)
    return hyst.Record(u, y + scatter, dt)


def delayed(
    plant: Callable[[Array], Array], shape: str, decay: float, noise: float, delay: float, seed: int
) -> hyst.Record:
    """Simulate five times finer where the delay is no whole number."""
    fine = 1 if delay == round(delay) else FINE
    u = drive(shape, decay, RATE * fine)
    y = plant(u)
    y = np.concatenate([np.full(round(delay * fine), y[0]), y])[: u.size]
    return noisy(u[::fine], y[::fine], noise, seed)


def preisach(u: Array, seed: int) -> Array:
    """Give the output of relays of a smooth density on the half plane of their thresholds."""
    rng = np.random.default_rng(seed)
    level = np.linspace(-1.0, 1.0, 40)
    up, down = (each[np.triu_indices(40)] for each in np.meshgrid(level, level, indexing="xy"))
    width, spread, shift = rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.3), rng.uniform(0.1, 0.3)
    distance = (((up - down) / 2.0 - width) / spread) ** 2 + ((up + down) / 2.0 / shift) ** 2
    weights = np.exp(-distance / 2.0)
    weights /= weights.sum()
    state = np.where(up + down > 0.0, -1.0, 1.0)
    y = np.empty_like(u)
    for k, sample in enumerate(u):
        state[sample >= up] = 1.0
        state[sample <= down] = -1.0
        y[k] = weights @ state
    return np.asarray(y + rng.uniform(0.0, 0.3) * u)


def bouc_wen(u: Array, seed: int) -> Array:
    """Give a line less a loop that approaches its limit as fast as the seed says."""
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(0.2, 1.0), rng.uniform(0.5, 4.0)
    g = rng.uniform(-0.9, 0.9) * b
    z = integrated(u, lambda du, z: a * du - b * abs(du) * z - g * du * abs(z), 20)
    steepest = float(np.abs(np.diff(z)).max() / np.abs(np.diff(u)).max())
    return np.asarray(2.0 * steepest * u - z)


def dahl(u: Array, seed: int) -> Array:
    """Give a friction force, steep after every turn."""
    stiffness = float(np.random.default_rng(seed).uniform(2.0, 30.0))
    return integrated(u, lambda du, z: stiffness * du * (1.0 - z * float(np.sign(du))), 10)


def butterfly(u: Array, seed: int) -> Array:
    """Give the square of a switching material's output."""
    v = preisach(u, seed)
    return np.asarray((v / np.abs(v).max()) ** 2 + 0.1 * v)


def rate_dependent(u: Array, dt: float) -> Array:
    """Give plays whose radii grow with the rate of their input."""
    rate = np.abs(np.diff(u, prepend=u[0])) / dt
    y, z = 0.8 * u, np.zeros(3)
    for k, sample in enumerate(u):
        r = np.array([0.05, 0.15, 0.3]) + 0.01 * rate[k]
        z = np.clip(z, sample - r, sample + r)
        y[k] += z @ np.array([0.4, 0.3, 0.2])
    return np.asarray(y)


def integrated(u: Array, step: Callable[[float, float], float], parts: int) -> Array:
    """Integrate along the input, by so many steps a sample."""
    z, result = 0.0, np.empty_like(u)
    for k, change in enumerate((np.diff(u, prepend=u[0]) / parts).tolist()):
        for _ in range(parts):
            z += step(change, z)
        result[k] = z
    return result

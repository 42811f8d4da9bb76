"""Records of actuators that no family describes, and of those that something disturbs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.signal
from numpy.typing import NDArray

import hyst
from hyst import Record

Array = NDArray[np.float64]

DT = 1e-3
DRIVES = ("sine", "triangle", "decaying sine", "multisine")


def drive(kind: str, amplitude: float = 1.0, seed: int = 0, samples: int = 4000) -> Array:
    """Give a drive of some cycles, or a multisine of fifteen lines."""
    rng = np.random.default_rng(seed)
    t = np.arange(samples) * DT
    phase = 2.0 * np.pi * 2.0 * t + rng.uniform(0.0, 2.0 * np.pi)
    if kind == "multisine":
        lines, phases = np.arange(1, 16), rng.uniform(0.0, 2.0 * np.pi, 15)
        u = np.sin(2.0 * np.pi * np.outer(t / t[-1], lines) + phases).sum(axis=1)
        return amplitude * u / np.abs(u).max()
    u = np.sin(phase)
    if kind == "triangle":
        u = 2.0 / np.pi * np.arcsin(u)
    if kind == "decaying sine":
        u = u * (1.0 - 0.75 * t / t[-1])
    return amplitude * u


def plays(amplitude: float = 1.0, seed: int = 0) -> hyst.PrandtlIshlinskii:
    """Give three plays with radii inside a drive of this amplitude."""
    rng = np.random.default_rng(seed)
    radii = amplitude * np.array([0.1, 0.3, 0.6]) * rng.uniform(0.8, 1.2, 3)
    return hyst.PrandtlIshlinskii(rng.uniform(0.1, 0.4, 3), radii, rng.uniform(0.3, 1.0))


def record(u: Array, y: Array, noise: float = 0.0, seed: int = 0) -> Record:
    """Give a record with white noise of a share of the output's range."""
    sensor = noise * np.ptp(y) * np.random.default_rng(seed + 1000).standard_normal(u.size)
    return Record(u, y + sensor, DT, input_unit="V", output_unit="um")


def bouc_wen(u: Array) -> Array:
    """Give ``y = 0.6 u - z`` with ``z' = 0.35 u' - b |u'| z - b/2 u' |z|``: softening."""
    amplitude, z, y = np.ptp(u) / 2.0, 0.0, np.empty(u.size)
    before = u[0]
    for k, now in enumerate(u):
        step = (now - before) / amplitude
        z += 0.35 * step * amplitude - 2.0 * abs(step) * z - step * abs(z)
        y[k], before = 0.6 * now - z, now
    return y


def switching(u: Array) -> Array:
    """Give a Preisach model of relays that switch near a coercive field, and a small slope."""
    rng = np.random.default_rng(3)
    up, down = rng.normal(0.35, 0.12, 1500), rng.normal(-0.35, 0.12, 1500)
    up, down = np.maximum(up, down), np.minimum(up, down)
    state, y = -np.ones(up.size), np.empty(u.size)
    x = u / np.abs(u).max()
    for k, now in enumerate(x):
        state[now >= up], state[now <= down] = 1.0, -1.0
        y[k] = state.mean()
    return y + 0.1 * x


def late(y: Array, samples: float) -> Array:
    """Give a signal that many samples, or parts of one, later."""
    k = np.arange(y.size, dtype=float)
    return np.interp(k - samples, k, y)


def ringing(y: Array, frequency: float = 60.0, damping: float = 0.1) -> Array:
    """Give what a resonance makes of a signal."""
    w = 2.0 * np.pi * frequency
    b, a, _ = scipy.signal.cont2discrete(([w * w], [1.0, 2.0 * damping * w, w * w]), DT)
    return scipy.signal.lfilter(b[0], a, y - y[0]) + y[0]


def at_rates(
    frequencies: tuple[float, ...], growth: float, seed: int, noise: float
) -> list[Record]:
    """Give records of plays whose weights grow by a share for each decade of the frequency."""
    result = []
    for number, frequency in enumerate(frequencies):
        samples = max(600, int(2500 / frequency))
        u = np.sin(2.0 * np.pi * frequency * np.arange(samples) * DT)
        slow = plays(seed=seed)
        weights = slow.p * (1.0 + growth * np.log10(frequency))
        y = hyst.PrandtlIshlinskii(weights, slow.r, slow.p0)(u)
        result.append(record(u, y, noise, seed + number))
    return result


Foreign = Callable[[Array, int, float], Record | list[Record]]


def _own(u: Array, seed: int) -> Array:
    return plays(float(np.ptp(u)) / 2.0, seed)(u)


def _spiky(u: Array, seed: int, noise: float) -> Record:
    clean = record(u, _own(u, seed), noise, seed)
    y, rng = clean.y.copy(), np.random.default_rng(seed)
    y[rng.choice(np.arange(400, u.size), 8, replace=False)] += 0.3 * np.ptp(y)
    return Record(u, y, DT)


def _two(u: Array, seed: int, noise: float) -> Record:
    y = _own(u, seed)
    second = u.size // 2
    return record(u, np.concatenate([y[:second], 1.4 * y[second:]]), noise, seed)


FOREIGN: dict[str, Foreign] = {
    "another shape": lambda u, seed, noise: record(u, switching(u), noise, seed),
    "square": lambda u, seed, noise: record(u, u**2, noise, seed),
    "butterfly": lambda u, seed, noise: record(u, switching(u) ** 2, noise, seed),
    "drift": lambda u, seed, noise: record(
        u, _own(u, seed) + 0.05 * np.ptp(_own(u, seed)) * np.arange(u.size) / u.size, noise, seed
    ),
    "creep": lambda u, seed, noise: record(
        u,
        _own(u, seed) + 0.08 * np.ptp(_own(u, seed)) * (1.0 - np.exp(-np.arange(u.size) / 700.0)),
        noise,
        seed,
    ),
    "hum": lambda u, seed, noise: record(
        u,
        _own(u, seed)
        + 0.01 * np.ptp(_own(u, seed)) * np.sin(2.0 * np.pi * 50.0 * DT * np.arange(u.size) + seed),
        noise,
        seed,
    ),
    "outliers": _spiky,
    "change": _two,
    "noise": lambda u, seed, _: Record(u, np.random.default_rng(seed).normal(size=u.size), DT),
    "rate": lambda _, seed, noise: at_rates((1.0, 10.0, 40.0), 0.25, seed, noise),
    "records": lambda u, seed, noise: [
        record(u, gain * _own(u, seed), noise, seed + int(100 * gain)) for gain in (1.0, 1.06, 0.95)
    ],
}
"""By what a fit to them leaves."""

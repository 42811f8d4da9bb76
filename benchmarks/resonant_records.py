"""Records of actuators with hysteresis before dynamics, fits from the truth, and errors of both.

Dynamics are simulated by scipy; hysteresis by hyst's operators, whose values the tests hold to
independent ones.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.signal
from numpy.typing import NDArray

import hyst
from hyst.errors import HystError
from hyst.identification.families.hammerstein.joint import joint
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.problem import problem_of
from hyst.identification.fit_model import parametrize_own
from hyst.identification.record_use.used_samples import prepare
from hyst.models import LinearDynamics
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]
Mode = tuple[float, float]

SAMPLES = 20_000
FRONT = hyst.PrandtlIshlinskii([0.12, 0.09, 0.08, 0.06, 0.05], [0.5, 1.5, 3.0, 5.0, 8.0], 0.6)
"""Five plays, for drives of amplitude 10."""


@dataclass(frozen=True)
class Stage:
    """A hysteresis, then dynamics ``b / a`` of gain 1 at rest and whole samples of delay."""

    front: Operator
    b: Array
    a: Array
    dt: float
    delay: int = 0

    def __call__(self, u: Array) -> Array:
        """Simulate it from rest."""
        late = np.zeros(u.size)
        late[self.delay :] = self.front(u)[: u.size - self.delay]
        return np.asarray(scipy.signal.lfilter(self.b, self.a, late))

    @property
    def order(self) -> int:
        """Number of states."""
        return self.a.size - 1

    def dynamics(self) -> LinearDynamics:
        """Give the dynamics in balanced coordinates, in which a fit is well conditioned."""
        return balanced(LinearDynamics.from_transfer_function(self.b, self.a, self.dt, self.delay))


def stage(
    front: Operator,
    modes: list[Mode],
    dt: float,
    delay: int = 0,
    zeros: Mode | None = None,
    poles: Mode | None = None,
) -> Stage:
    """Give a hysteresis before resonances in series; zeros over poles is a notch beside them."""
    b = a = np.ones(1)
    for frequency, damping in modes:
        n, d = _sampled([1.0], _second(frequency, damping), dt)
        b, a = np.convolve(b, n), np.convolve(a, d)
    if zeros is not None and poles is not None:
        n, d = _sampled(_second(*zeros), _second(*poles), dt)
        b, a = np.convolve(b, n), np.convolve(a, d)
    return Stage(front, b, a, dt, delay)


def multisine(
    dt: float, low: float, high: float, amplitude: float, seed: int, samples: int = SAMPLES
) -> Array:
    """Give a period of lines of equal power between two frequencies, phases by chance."""
    frequencies = np.fft.rfftfreq(samples, dt)
    among = (frequencies >= low) & (frequencies <= high) & (frequencies > 0.0)
    lines = np.zeros(frequencies.size, dtype=complex)
    lines[among] = np.exp(2j * np.pi * np.random.default_rng(seed).random(int(among.sum())))
    u = np.fft.irfft(lines, samples)
    return np.asarray(amplitude * u / np.abs(u).max())


def drives(dt: float = 1e-4, amplitude: float = 10.0) -> Iterator[tuple[str, Array]]:
    """Give drives that amplifiers can play, of 20,000 samples."""
    t, rng = np.arange(SAMPLES) * dt, np.random.default_rng(5)
    for high in (5000.0, 3300.0, 1000.0, 500.0):
        yield f"multisine to {high:g} Hz", multisine(dt, 1.0, high, amplitude, int(high))
    for spacing in ("linear", "logarithmic"):
        swept = scipy.signal.chirp(t, 1.0, t[-1], 1000.0, spacing, phi=-90.0)
        yield f"{spacing} chirp, 1-1000 Hz", amplitude * swept
    yield "levels held 5", np.repeat(rng.uniform(-amplitude, amplitude, SAMPLES // 5), 5)
    b, a = scipy.signal.butter(4, 1000.0 * 2.0 * dt)
    x = scipy.signal.lfilter(b, a, rng.normal(size=SAMPLES))
    yield "noise below 1 kHz", amplitude * x / np.abs(x).max()
    yield (
        "triangle, 10 Hz",
        amplitude * scipy.signal.sawtooth(2.0 * np.pi * 10.0 * t + np.pi / 2.0, 0.5),
    )
    yield (
        "three sines",
        amplitude / 3.0 * np.sum([np.sin(2.0 * np.pi * f * t) for f in (3.0, 11.0, 47.0)], axis=0),
    )


def measured(plant: Stage, u: Array, decibels: float, seed: int) -> hyst.Record:
    """Give a record with white noise so far below the output, once it has started."""
    y = plant(u)
    noise = y[y.size // 10 :].std() * 10.0 ** (-decibels / 20.0)
    return hyst.Record(u, y + noise * np.random.default_rng(seed).normal(size=y.size), plant.dt)


def error_percent(
    model: Callable[[Array], Array], plant: Callable[[Array], Array], u: Array
) -> float:
    """Give the rms error of the noise-free output after the first quarter, % of its rms."""
    after = slice(u.size // 4, None)
    y = plant(u)
    return float(100.0 * np.std((model(u) - y)[after]) / np.std(y[after]))


def fitted_from_truth(plant: Stage, record: hyst.Record) -> Operator:
    """Give the least-squares fit of the plant's own structure that starts from the truth."""
    data = prepare(record, "auto")
    front = Affine(1.0, 0.0) @ plant.front
    names = [
        name for name in front.parameters().names if name != "affine.gain" and "z0" not in name
    ]
    parametrization, theta = joint(parametrize_own(front, names, {}), plant.dynamics())
    found = minimize(problem_of(data, parametrization), theta, 100, 1e-4)
    return parametrization.operator(found.theta)


@dataclass(frozen=True)
class Run:
    """An automatic identification, or why it was refused, and its processor time."""

    found: Any
    refused: str
    seconds: float


def identified(record: hyst.Record | list[hyst.Record], **options: Any) -> Run:
    """Identify with everything automatic but what is given."""
    start = time.process_time()
    try:
        found = hyst.identify(record, family="hammerstein", **{"hysteresis": "pi", **options})
    except HystError as error:
        return Run(None, f"{type(error).__name__}: {error}", time.process_time() - start)
    return Run(found, "", time.process_time() - start)


def balanced(dynamics: LinearDynamics) -> LinearDynamics:
    """Give the same dynamics in balanced coordinates."""
    A, B, C = dynamics.A, dynamics.B[:, None], dynamics.C[None]
    seen = scipy.linalg.solve_discrete_lyapunov(A.T, C.T @ C, "bilinear")
    root = np.linalg.cholesky(scipy.linalg.solve_discrete_lyapunov(A, B @ B.T, "bilinear"))
    u, s, _ = np.linalg.svd(root.T @ seen @ root)
    T = root @ u / s**0.25
    back = np.linalg.inv(T)
    moved = back @ A @ T, back @ dynamics.B, dynamics.C @ T
    return LinearDynamics(*moved, dynamics.D, dynamics.dt, dynamics.delay)


def with_feedback(u: Array, share: float, dt: float) -> Array:
    """Simulate a mass on springs of which a share slides: the hysteresis is in the loop."""
    w, parts = 2.0 * np.pi * 200.0, 8
    h = dt / parts
    r, p, z = (0.5, 1.5, 3.0, 5.0), (0.6, 0.5, 0.5, 0.4), [0.0] * 4
    y, v, out = 0.0, 0.0, np.empty_like(u)
    for k, now in enumerate(u.tolist()):
        for _ in range(parts):
            z = [max(y - a, min(y + a, b)) for a, b in zip(r, z, strict=True)]
            force = sum(a * (y - b) for a, b in zip(p, z, strict=True))
            v += h * (w * w * (now - (1.0 - share) * y - share * force) - 0.06 * w * v)
            y += h * v
        out[k] = y
    return out


def _second(frequency: float, damping: float) -> list[float]:
    w = 2.0 * np.pi * frequency
    return [1.0 / w**2, 2.0 * damping / w, 1.0]


def _sampled(numerator: list[float], denominator: list[float], dt: float) -> tuple[Array, Array]:
    n, d, _ = scipy.signal.cont2discrete((numerator, denominator), dt)
    return np.asarray(n).ravel(), np.asarray(d)

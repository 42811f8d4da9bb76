"""A lag of part of a sample: how often constants, lag and their errors hold the truth.

The actuator of S4 (sec. IV-C) at 10 kHz, its amplifier late by 0.42 samples (1.5 degrees at
100 Hz), records at 10, 50 and 100 Hz with 0.3 of noise. The plant is written here from the paper's
equations: ``sampled`` takes the rate as the paper does, from one sample to the next of what the
amplifier gives; ``fine`` runs 50 steps a sample, so that its rate is the rate of that very time.
Prints, over 100 seeds, how often beta and the lag are within two standard errors or in the interval
that is told, by default; beside it, over a tenth as many, what it is with the lag left in
(``delay=0``), and with the lag as a stage of the model (``lag="auto"``).

``python -m benchmarks lag [--runs N]``
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]

RUNS = 100
DT = 1e-4
FINE = 50
NOISE = 0.3
FREQUENCIES = ((10.0, 2.5), (50.0, 10.0), (100.0, 20.0))
"""Hz, and periods of each record."""

P, R, P0, BETA = (0.2906, 0.0461, 0.1512), (9.715, 19.43, 29.145), 0.7124, 8.572e-4
LAG = 0.42
"""Samples."""


@dataclass(frozen=True)
class Plant:
    """One kind of lag, one share of the paper's beta, and how finely the rate is taken."""

    lag: str
    share: float
    steps: int
    late: float = LAG

    @property
    def name(self) -> str:
        """What the table calls it."""
        how = "sampled" if self.steps == 1 else "fine"
        return f"{self.lag:11s} {self.late:5.2f} {how:8s} beta x {self.share:g}"


PLANTS = tuple(
    Plant(lag, share, steps)
    for share in (1.0, 0.0)
    for steps in (1, FINE)
    for lag in ("none", "delay", "first-order")
    if not (share == 0.0 and steps > 1)
)


def main() -> None:
    """Print coverage by plant and by way to identify."""
    words = sys.argv[1:]
    runs = int(words[words.index("--runs") + 1]) if "--runs" in words else RUNS
    print(f"{'plant':38s} {'options':12s} beta in 2 s.e.  mean s.e.   bias lag held mean lag  runs")
    for plant in PLANTS:
        clean = [clean_record(plant, f, n) for f, n in FREQUENCIES]
        for name, options in WAYS.items():
            count = runs if not options else max(runs // 10, 1)
            found = [run(clean, seed, options) for seed in range(count)]
            print(row(plant, name, found), flush=True)


WAYS: dict[str, dict[str, Any]] = {
    "default": {},
    "delay=0": {"delay": 0},
    "lag='auto'": {"lag": "auto"},
}


def clean_record(plant: Plant, frequency: float, periods: float) -> tuple[Array, Array]:
    """Give the command and the output without noise, at the sample time."""
    count = round(periods / frequency / DT)
    late = plant.late * DT if plant.lag != "none" else 0.0
    step = DT / plant.steps
    given = amplifier(plant.lag, late, frequency)(np.arange(count * plant.steps) * step)
    rate = np.abs(np.diff(given, prepend=given[0])) / step
    y = plays(given, plant.share * BETA * rate)[:: plant.steps]
    u = 40.0 * np.sin(2.0 * np.pi * frequency * np.arange(count) * DT)
    return u, y


def amplifier(lag: str, late: float, frequency: float) -> Callable[[Array], Array]:
    """Give its voltage over time for a command of a sine that begins at 0."""
    w = 2.0 * np.pi * frequency
    if lag != "first-order":
        return lambda t: 40.0 * np.sin(w * np.maximum(t - late, 0.0))
    gain, phase = 1.0 / np.hypot(1.0, w * late), np.arctan(w * late)
    return lambda t: 40.0 * gain * (np.sin(w * t - phase) + np.sin(phase) * np.exp(-t / late))


def plays(u: Array, widening: Array) -> Array:
    """Give the output of S4 eq. 38 for thresholds that widen."""
    memory, y = [0.0] * len(P), np.empty_like(u)
    for k, (x, b) in enumerate(zip(u.tolist(), widening.tolist(), strict=True)):
        memory = [max(x - r - b, min(x + r + b, z)) for r, z in zip(R, memory, strict=True)]
        y[k] = P0 * x + sum(p * z for p, z in zip(P, memory, strict=True))
    return y


@dataclass(frozen=True)
class Run:
    """What one identification told."""

    beta: float
    error: float
    delay: float
    interval: tuple[float, float]
    """Samples: of the delay, or of the time constant where the model has one."""


def run(clean: list[tuple[Array, Array]], seed: int, options: dict[str, Any]) -> Run:
    """Identify from the records with the noise of a seed."""
    random = np.random.default_rng(seed)
    records = [hyst.Record(u, y + NOISE * random.standard_normal(y.size), DT) for u, y in clean]
    found = hyst.identify(records, family="rdpi", plays=3, **options)
    place = next(i for i, each in enumerate(found.parameter_names) if each.endswith("beta"))
    return Run(
        float(found.parameter_values[place]),
        float(found.standard_errors[place]),
        float(found.delay) if found.lag is None else found.lag / DT,
        found.delay_interval if found.lag_interval is None else _in_samples(found.lag_interval),
    )


def _in_samples(interval: tuple[float, float]) -> tuple[float, float]:
    return interval[0] / DT, interval[1] / DT


def row(plant: Plant, name: str, found: list[Run]) -> str:
    """Give the line of one plant and one way."""
    beta = plant.share * BETA
    values, errors = np.array([e.beta for e in found]), np.array([e.error for e in found])
    # A value on the bound 0 has no error: it holds the truth only if that is 0.
    inside = np.where(np.isnan(errors), values == beta, np.abs(values - beta) <= 2.0 * errors)
    late = plant.late if plant.lag != "none" else 0.0
    delays = np.mean([e.delay for e in found])
    held = np.mean([e.interval[0] <= late <= e.interval[1] for e in found])
    return (
        f"{plant.name:38s} {name:12s} {inside.mean():12.2f} {np.nanmean(errors) / BETA:11.4f} "
        f"{(values.mean() - beta) / BETA:7.4f} {held:8.2f} {delays:8.3f} {len(found):5d}"
    )


if __name__ == "__main__":
    main()

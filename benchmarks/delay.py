"""Delays with evidence: how often the interval holds the true delay, and the estimate is right.

Random plays (four of them, 1 Hz at 200 Hz, 8 s), alone, below a map of dead zones or below a cubic,
each with the noise named, in parts of the output's range. Prints

- for no delay: how often the interval holds 0, how often the estimate is 0, the width,
- for true delays of 1.4 and 4 samples: the same, how often 0 is excluded, and how often the
  estimate is within 0.1 sample,
- for materials and friction that are no plays (Preisach, Bouc-Wen, Dahl, butterflies), without a
  delay: how often the estimate is 0,
- the time of one estimate.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.diagnosis.delay_evidence import DelayEvidence, evidence_of_delay

Array = NDArray[np.float64]
Rng = np.random.Generator

RATE, PERIODS = 200, 8
SEEDS = range(5000, 5006)
"""None of those that the method was made on."""
FINE = 5
"""Steps a sample, where the true delay is no whole number."""


def main() -> None:
    without_delay()
    with_delay()
    no_plays()
    times()


def without_delay() -> None:
    print("no delay           noise   holds 0  estimate 0  width")
    everything = []
    for shape in ("sine", "triangle"):
        for decay in (0.0, 0.75):
            for kind in ("pi", "mpi", "cubic"):
                for noise in (0.003, 0.01, 0.05):
                    found = [found_in(shape, decay, kind, noise, s, 0.0) for s in SEEDS]
                    everything += found
                    print(f"{named(shape, decay, kind)} {noise:7.3f} {shares(found)}", flush=True)
    print(f"all {len(everything)} runs {' ' * 15} {shares(everything)}")


def with_delay() -> None:
    print("\ntrue delay           noise  holds it  excludes 0  within 0.1  width")
    for delay in (1.4, 4.0):
        for shape, decay in (("triangle", 0.0), ("triangle", 0.75), ("sine", 0.75)):
            for kind in ("pi", "mpi", "cubic"):
                for noise in (0.001, 0.003):
                    found = [found_in(shape, decay, kind, noise, s, delay) for s in SEEDS]
                    held = np.mean([each.low <= delay <= each.high for each in found])
                    excluded = np.mean([each.excludes_zero for each in found])
                    near = np.mean([abs(each.delay - delay) <= 0.1 for each in found])
                    width = np.mean([each.high - each.low for each in found])
                    print(
                        f"{delay:3g} {named(shape, decay, kind)} {noise:6.3f} {held:8.2f} "
                        f"{excluded:11.2f} {near:11.2f} {width:8.2f}",
                        flush=True,
                    )


def no_plays() -> None:
    print("\nno plays, no delay   noise  holds 0  estimate 0  width")
    for name, plant in PLANTS.items():
        for noise in (0.0, 0.003, 0.01, 0.03):
            found = []
            for seed in SEEDS:
                for shape in ("sine", "triangle"):
                    for decay in (0.0, 0.75):
                        rng = np.random.default_rng(seed)
                        u = drive(shape, decay, RATE)
                        found.append(
                            evidence_of_delay([noisy(u, plant(u, rng), noise, rng)], [150])
                        )
            print(f"{name:18s} {noise:7.3f} {shares(found)}", flush=True)


def times() -> None:
    print("\nsamples   time of one estimate")
    rng = np.random.default_rng(0)
    for samples in (1_600, 10_000, 100_000, 1_000_000):
        u = np.sin(np.arange(samples) * (2.0 * np.pi / min(samples / 8.0, 20_000.0)))
        record = noisy(u, random_plant(rng, "mpi")(u), 0.003, rng)
        begin = time.process_time()
        evidence_of_delay([record], [samples // 10])
        print(f"{samples:9d} {time.process_time() - begin:8.2f} s")


def named(shape: str, decay: float, kind: str) -> str:
    return f"{shape:8s} {'decaying' if decay else 'one':8s} {kind:5s}"


def shares(found: list[DelayEvidence]) -> str:
    held = np.mean([each.low <= 0.0 <= each.high for each in found])
    zero = np.mean([each.delay == 0.0 for each in found])
    return f"{held:8.2f} {zero:8.2f} {np.mean([each.high - each.low for each in found]):10.1f}"


def found_in(
    shape: str, decay: float, kind: str, noise: float, seed: int, delay: float
) -> DelayEvidence:
    record = delayed_record(shape, decay, kind, noise, seed, delay)
    return evidence_of_delay([record], [150])


def delayed_record(
    shape: str, decay: float, kind: str, noise: float, seed: int, delay: float
) -> hyst.Record:
    """Simulate a random plant, finely where its delay is no whole number of samples."""
    rng = np.random.default_rng(seed)
    fine = 1 if delay == round(delay) else FINE
    u = drive(shape, decay, RATE * fine)
    y = random_plant(rng, kind)(u)
    y = np.concatenate([np.full(round(delay * fine), y[0]), y])[: u.size]
    return noisy(u[::fine], y[::fine], noise, rng)


def noisy(u: Array, y: Array, noise: float, rng: Rng) -> hyst.Record:
    return hyst.Record(u, y + noise * np.ptp(y) * rng.standard_normal(u.size), 1.0 / RATE)


def drive(shape: str, decay: float, rate: int) -> Array:
    t = np.arange(PERIODS * rate) / rate
    wave = np.sin(2.0 * np.pi * t)
    wave = wave if shape == "sine" else 2.0 / np.pi * np.arcsin(wave)
    return np.asarray((1.0 - decay * t / t[-1]) * wave)


def random_plant(rng: Rng, kind: str) -> Callable[[Array], Array]:
    p, r = 0.3 * rng.exponential(size=4), np.sort(rng.uniform(0.03, 0.8, 4))
    plays = hyst.PrandtlIshlinskii(p, r, float(rng.uniform(0.3, 1.0)))
    if kind == "pi":
        return plays
    if kind == "mpi":
        bends = np.array([-0.6, -0.3, 0.3, 0.6]) * float(plays(np.array([1.0]))[0])
        weights = np.concatenate([[1.0], rng.uniform(-0.2, 0.4, 4)])
        return hyst.ModifiedPrandtlIshlinskii(plays, hyst.DeadZone(weights, [0.0, *bends]))

    def cubic(u: Array) -> Array:
        v = plays(u)
        return np.asarray(v + 0.6 * (v**2 - 0.3 * v**3) / np.ptp(v))

    return cubic


def preisach(u: Array, rng: Rng) -> Array:
    """Give the output of relays of a smooth density on the half plane of their thresholds."""
    level = np.linspace(-1.0, 1.0, 50)
    up, down = (each[np.triu_indices(50)] for each in np.meshgrid(level, level))
    width, spread, shift = rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.3), rng.uniform(0.1, 0.3)
    weights = np.exp(
        -(((up - down) / 2.0 - width) ** 2) / (2.0 * spread**2)
        - ((up + down) / 2.0) ** 2 / (2.0 * shift**2)
    )
    weights /= weights.sum()
    state = np.where(up + down > 0.0, -1.0, 1.0)
    y = np.empty_like(u)
    for k, sample in enumerate(u):
        state[sample >= up] = 1.0
        state[sample <= down] = -1.0
        y[k] = weights @ state
    return np.asarray(y + rng.uniform(0.0, 0.3) * u)


def bouc_wen(u: Array, rng: Rng) -> Array:
    """Give a friction loop, or a loop of a piezo actuator: a line less a friction loop."""
    a, b = rng.uniform(0.2, 1.0), rng.uniform(0.5, 4.0)
    g = rng.uniform(-0.9, 0.9) * b
    z = integrated(u, lambda du, z: a * du - b * abs(du) * z - g * du * abs(z), 20)
    steepest = np.abs(np.diff(z)).max() / np.abs(np.diff(u)).max()
    if rng.random() < 0.5:
        return np.asarray(2.0 * steepest * u - z)
    return np.asarray(z + rng.uniform(0.0, 0.5) * u)


def dahl(u: Array, rng: Rng) -> Array:
    stiffness, power = rng.uniform(2.0, 30.0), rng.choice([0.5, 1.0, 2.0])

    def step(du: float, force: float) -> float:
        left = 1.0 - force * np.sign(du)
        return float(stiffness * du * abs(left) ** power * np.sign(left))

    return np.asarray(integrated(u, step, 10) + rng.choice([0.0, 0.3]) * u)


def butterfly(u: Array, rng: Rng) -> Array:
    v = preisach(u, rng)
    v = v / np.abs(v).max()
    return np.asarray(v**2 + rng.uniform(0.0, 0.3) * v)


def integrated(u: Array, step: Callable[[float, float], float], parts: int) -> Array:
    z, result = 0.0, np.empty_like(u)
    for k, change in enumerate(np.diff(u, prepend=u[0]) / parts):
        for _ in range(parts):
            z += step(float(change), z)
        result[k] = z
    return result


PLANTS = {"Preisach": preisach, "Bouc-Wen": bouc_wen, "Dahl": dahl, "butterfly": butterfly}

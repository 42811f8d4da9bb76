"""Bands: the share of samples they hold, on records of the models' own classes and on others.

A band of 95 % is to hold 0.92 to 0.98 of the samples of a drive that no fit has seen where the
actuator is of a model's class, and at least 0.90 where it is of none, for drives inside the range.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.plants import Plant, major_loops, nested_loops, plants, shrinking_loops

Array = NDArray[np.float64]

LEVEL = 0.95
NOISE = 0.003
"""Of the output's range."""

RUNS = 40
DT = 0.01


def main() -> None:
    """Print both tables."""
    print_own_classes()
    print_foreign()


def print_own_classes() -> None:
    """Print what is held of random plays, with and without maps."""
    print(f"\nshare of samples in a band of {LEVEL:.0%}, {RUNS} random actuators a row")
    print(f"  {'actuator':18s} {'noise':>6s} {'mean':>6s} {'least':>6s} {'most':>6s}")
    for name in ("plays", "plays and a map", "envelope and plays"):
        for noise in (0.003, 0.01, 0.05):
            held = [held_in_class(name, noise, seed) for seed in range(RUNS)]
            print(
                f"  {name:18s} {noise:6.1%} {np.mean(held):6.3f} {min(held):6.3f} {max(held):6.3f}"
            )


def held_in_class(name: str, noise: float, seed: int) -> float:
    """Give the share held of a drive of the same kind as the record, for one random actuator."""
    rng = np.random.default_rng(seed)
    truth = _random_model(name, rng)
    u, other = multisine(2000, seed), multisine(2000, seed + 1000)
    # Inside the range, from rest: nothing beyond it can be asked of a band.
    other = other * 0.97 * min(u.max() / other.max(), u.min() / other.min())
    y = truth(u)
    sigma = noise * float(np.ptp(y))
    found = hyst.identify(hyst.Record(u, y + sigma * rng.standard_normal(u.size), DT))
    low, high = found.band(other, LEVEL)
    measured = truth(other) + sigma * rng.standard_normal(other.size)
    return float(np.mean((measured >= low) & (measured <= high)))


def print_foreign() -> None:
    """Print what is held of actuators of no model's class, on nested minor loops."""
    print("\nshare of nested minor loops in the band, actuators of no model's class")
    print(f"  {'actuator':36s} {'one amplitude':>14s} {'shrinking':>10s}   half-widths, % of range")
    held: list[list[float]] = []
    for plant in plants():
        row = [held_of(plant, drive) for drive in (major_loops(), shrinking_loops())]
        held.append([share for share, _ in row])
        widths = ", ".join(f"{width:.1f}" for _, width in row)
        print(f"  {plant.name:36s} {row[0][0]:14.3f} {row[1][0]:10.3f}   {widths}", flush=True)
    mean = np.mean(held, axis=0)
    print(f"  {'mean':36s} {mean[0]:14.3f} {mean[1]:10.3f}")


def held_of(plant: Plant, drive: Array, seed: int = 1) -> tuple[float, float]:
    """Give the share of nested minor loops that is held, and the mean half-width in percent."""
    rng = np.random.default_rng(seed)
    y = plant.output(drive)
    span = float(np.ptp(y))
    record = hyst.Record(drive, y + NOISE * span * rng.standard_normal(y.size), DT)
    found = hyst.identify(record)
    other = np.concatenate([drive, nested_loops()])
    later = slice(drive.size, None)
    low, high = (each[later] for each in found.band(other, LEVEL))
    truth = plant.output(other)[later]
    measured = truth + NOISE * span * rng.standard_normal(truth.size)
    share = float(np.mean((measured >= low) & (measured <= high)))
    return share, 50.0 * float(np.mean(high - low)) / span


def multisine(samples: int, seed: int) -> Array:
    """Give a drive of random phases with peak 1: loops of all sizes."""
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, 8)
    angles = 2.0 * np.pi * np.outer(np.arange(samples), np.arange(1, 9)) * 3 / samples
    waves = np.sin(angles + phases).sum(axis=1)
    return np.asarray(waves / np.abs(waves).max())


def _random_model(name: str, rng: np.random.Generator) -> hyst.Operator:
    count = int(rng.integers(2, 5))
    radii = np.sort(rng.uniform(0.05, 0.8, count))
    plays = hyst.PrandtlIshlinskii(
        rng.uniform(0.1, 0.5, count), radii, float(rng.uniform(0.4, 1.0))
    )
    zone = hyst.DeadZone([1.0, float(rng.uniform(-0.3, 0.3)), 0.3], [0.0, 0.4, -0.4])
    if name == "plays":
        return plays
    return zone @ plays if name == "plays and a map" else plays @ zone


if __name__ == "__main__":
    main()

"""The choice of family, size and sign of weights, judged on minor loops it was not trained on.

Simulated actuators of many kinds (``plants``), each driven over its major loop or over loops of
shrinking amplitude, are identified with ``family="auto"`` and with every family and rule of weights
it could have chosen. Printed are errors of training and, without noise, of nested minor loops, in
percent of the output's range, and how many times the error of the best candidate the choice has.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.plants import Plant, major_loops, nested_loops, plants, shrinking_loops

FAMILIES = ("pi", "gpi", "mpi")
RULES = ("non-negative", "invertible")
NOISE = 0.003
FIRST_NESTED = 170
"""Sample of the nested loops from which on the memory is known."""

FLOOR = 0.2
"""Percent of the range: errors below count as this, for no one would tell them apart."""


def main() -> None:
    """Print a table for each drive."""
    for name, u in (("major loops", major_loops()), ("shrinking loops", shrinking_loops())):
        print(f"trained on {name}, noise {100 * NOISE:g} %: training -> minor loops, %")
        ratios = [print_plant(each, u) for each in plants()]
        print(f"  auto over best: median {np.median(ratios):.2f}, most {max(ratios):.2f}\n")


def print_plant(plant: Plant, u: NDArray[np.float64]) -> float:
    """Print one plant, and give the choice's error over the best candidate's."""
    record = simulated_record(plant, u, NOISE, 1)
    chosen = errors(plant, hyst.identify(record, delay=0))
    rows = {
        rule: [
            errors(plant, hyst.identify(record, family=family, weights=rule, delay=0))
            for family in FAMILIES
        ]
        for rule in RULES
    }
    best = min(minor for row in rows.values() for _, minor in row)
    ratio = max(chosen[1], FLOOR) / max(best, FLOOR)
    told = "  ".join(" ".join(f"{a:.2f}->{b:<5.2f}" for a, b in row) for row in rows.values())
    print(
        f"  {plant.kind:9s} {plant.name:34s} {told}  auto {chosen[0]:.2f}->{chosen[1]:<5.2f} "
        f"ratio {ratio:.2f}",
        flush=True,
    )
    return ratio


def simulated_record(plant: Plant, u: NDArray[np.float64], noise: float, seed: int) -> hyst.Record:
    """Give a record of a plant with white noise, a share of the output's range."""
    y = plant.output(u)
    scatter = noise * np.ptp(y) * np.random.default_rng(seed).standard_normal(y.size)
    return hyst.Record(u, y + scatter, dt=0.01)


def errors(plant: Plant, found: hyst.Identified) -> tuple[float, float]:
    """Give the error of training and of nested minor loops, percent of the output's range."""
    u = nested_loops()
    y = plant.output(u)
    left = (found.model(u) - y)[FIRST_NESTED:]
    minor = 100.0 * float(np.std(left)) / float(np.ptp(y))
    return found.metrics["training"].rms_percent, minor

"""Bands of the joint estimator: how often truths lie in them, and errors over the Cramer-Rao bound.

Random models of 2 to 6 plays, started with every weight and radius 20 to 40 % off, each in its own
direction, 20 s at 1 kHz, at 20 and 40 dB:
- a sine of 1 Hz,
- a staircase of the same, whose steps are a quarter of the mean gap between radii up to twice it,
- a sine of 50 Hz, 20 samples a period, where many sets of plays are the same at the samples.

Printed are, for each, the share of truths in their bands, or in their interval where the samples
only bracket them, in the runs in which the estimator says that it knows; the share of runs in
which it says that it does not, and of those in which it says so although all was right; and the
errors over the bound, of the constants the data determine, in their root mean square over a run:
the median and what 95 % of runs stay below. ``--runs N``, ``--drive a,b``, ``--decibels a,b``.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.online import JointEstimator

Array = NDArray[np.float64]

DT, SECONDS = 1e-3, 20.0
RUNS = 200
DRIVES = ("sine", "staircase", "fast")
DETERMINED = 1e-7


@dataclass(frozen=True)
class Task:
    """A plant, what drives it, and where the estimate starts."""

    truth: hyst.PrandtlIshlinskii
    start: hyst.PrandtlIshlinskii
    u: Array


def task_of(drive: str, seed: int) -> Task:
    rng = np.random.default_rng((DRIVES.index(drive), seed))
    plays = 2 + seed % 5
    p, r = rng.uniform(0.2, 1.0, plays), np.cumsum(rng.uniform(0.5, 1.5, plays))
    p0 = rng.uniform(0.5, 1.5)
    off = rng.uniform(0.2, 0.4, 2 * plays + 1) * rng.choice([-1.0, 1.0], 2 * plays + 1)
    start_r = r * (1.0 + off[plays + 1 :])
    order = np.argsort(start_r)
    start_p = (p * (1.0 + off[1 : plays + 1]))[order]
    start = hyst.PrandtlIshlinskii(start_p, start_r[order], p0 * (1.0 + off[0]))
    t = np.arange(round(SECONDS / DT)) * DT
    u = rng.uniform(1.5, 3.0) * r[-1] * np.sin(2.0 * np.pi * (50.0 if drive == "fast" else 1.0) * t)
    if drive == "staircase":
        step = r[-1] / plays * 2.0 ** rng.uniform(-2.0, 1.0)
        u = step * np.round(u / step)
    return Task(hyst.PrandtlIshlinskii(p, r, p0), start, u)


def right_of(truth: hyst.PrandtlIshlinskii) -> Array:
    return np.concatenate([[truth.p0], truth.p, truth.r, [0.0]])


def bound_of(truth: hyst.PrandtlIshlinskii, u: Array) -> Array:
    """Cramer-Rao bound over the noise; infinite for what the data do not determine."""
    jacobian = np.column_stack([truth.jacobian(u), np.ones(u.size)])
    scale = np.linalg.norm(jacobian, axis=0)
    _, size, directions = np.linalg.svd(jacobian / scale, full_matrices=False)
    known = size > DETERMINED * size[0]
    bound = np.linalg.norm(directions[known].T / size[known], axis=1) / scale
    bound[np.abs(directions[~known]).max(axis=0, initial=0.0) > DETERMINED] = np.inf
    return np.asarray(bound)


@dataclass(frozen=True)
class Outcome:
    """What one run ended with."""

    inside: NDArray[np.bool_]
    known: bool
    ratio: Array
    determined: NDArray[np.bool_]
    bounded: NDArray[np.bool_]
    nanoseconds: float


def run(drive: str, decibels: float, seed: int) -> Outcome:
    task = task_of(drive, seed)
    y = task.truth(task.u)
    sigma = float(np.std(y)) * 10.0 ** (-decibels / 20.0)
    noise = sigma * np.random.default_rng((7, seed)).standard_normal(y.size)
    estimator = JointEstimator(task.start, dt=DT)
    begin = time.process_time()
    estimator.run(hyst.Record(task.u, y + noise, DT), every=y.size)
    spent = time.process_time() - begin
    estimator.refine()
    right = right_of(task.truth)
    bound = sigma * bound_of(task.truth, task.u)
    told = estimator.knowledge
    inside = (told.low <= right) & (right <= told.high)
    known = not told.doubts
    ratio = np.abs(estimator.parameters - right) / bound
    return Outcome(inside, known, ratio, told.determined, np.isfinite(bound), 1e9 * spent / y.size)


def line_of(drive: str, decibels: float, outcomes: list[Outcome]) -> str:
    known = [each for each in outcomes if each.known]
    inside = share(known, lambda each: each.inside)
    everything = share(outcomes, lambda each: each.inside)
    determined = share(outcomes, lambda each: each.determined)
    of_data = share(outcomes, lambda each: each.bounded)
    right = sum(bool(each.inside.all()) for each in outcomes if not each.known)
    told = rms([each.ratio[each.bounded & each.determined] for each in known])
    of_bound = rms([each.ratio[each.bounded] for each in outcomes])
    return (
        f"{drive:10s} {decibels:3.0f} dB {len(outcomes):4d}  {inside:6.3f} {everything:6.3f} "
        f"{determined:10.3f} {of_data:7.3f} {1.0 - len(known) / len(outcomes):8.3f} "
        f"{right / len(outcomes):7.3f}  {np.median(told):6.2f} {np.quantile(told, 0.95):6.2f}  "
        f"{np.median(of_bound):6.2f} {np.quantile(of_bound, 0.95):7.2f} "
        f"{np.mean([each.nanoseconds for each in outcomes]):6.0f}"
    )


def share(outcomes: list[Outcome], of: Callable[[Outcome], NDArray[np.bool_]]) -> float:
    return float(np.mean(np.concatenate([of(each) for each in outcomes]))) if outcomes else np.nan


def rms(ratios: list[Array]) -> list[float]:
    found = [float(np.sqrt(np.mean(each**2))) for each in ratios if each.size]
    return found or [np.nan]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks online_bands")
    parser.add_argument("benchmarks", nargs="*")
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--drive", default=",".join(DRIVES))
    parser.add_argument("--decibels", default="20,40")
    asked = parser.parse_args(sys.argv[1:])
    print(
        "drive       noise  runs  inside    all  determined by data  unknown (right)  "
        "over bound: median, 95 %; all: median, 95 %  ns an update"
    )
    for drive in asked.drive.split(","):
        for decibels in asked.decibels.split(","):
            outcomes = [run(drive, float(decibels), seed) for seed in range(asked.runs)]
            print(line_of(drive, float(decibels), outcomes), flush=True)


if __name__ == "__main__":
    main()

"""Estimation of all constants of any family while it runs: errors, bands, and the time it takes.

For each family: random truths, starts 20 to 40 % off in every constant that is estimated, each in
its own direction, 8 s at 1 kHz, white noise at 20 and 40 dB. Drives: two sines (2 and 7.3 Hz), a
sine of 1 Hz that swells, a staircase, and a sine of 50 Hz with one of 3 Hz. Prints

- the error of the output of the start (frozen) and of the estimate (adapted) over the noise, on
  the same drive without noise,
- errors of the constants over the Cramer-Rao bound, which is made by differences of the model's
  output, independent of the estimator: root mean square of a run, median and 95 % of runs,
- the share of constants within the stated band, of those that are said to be determined by runs
  whose errors are said to be noise; and how many are,
- the processor time of an update, from Python.

``--runs N`` sets how many truths each row has, ``--family NAME`` picks one.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.online import ModelEstimator

Array = NDArray[np.float64]

DT = 1e-3
SAMPLES = 8000
RUNS = 25


def plays(rng: np.random.Generator, count: int = 2) -> hyst.PrandtlIshlinskii:
    r = np.cumsum(rng.uniform(0.3, 0.8, count))
    return hyst.PrandtlIshlinskii(rng.uniform(0.2, 0.8, count), r, rng.uniform(0.5, 1.5))


def bend(rng: np.random.Generator) -> hyst.DeadZone:
    above, below = rng.uniform(0.2, 0.6), rng.uniform(-0.5, -0.2)
    return hyst.DeadZone([1.0, above, below], [0.0, rng.uniform(1.0, 2.0), -rng.uniform(1.0, 2.0)])


def rate_dependent(rng: np.random.Generator) -> hyst.RateDependentPrandtlIshlinskii:
    rest = plays(rng)
    return hyst.RateDependentPrandtlIshlinskii(
        rest.p, rest.r, rng.uniform(0.003, 0.01), DT, rest.p0
    )


def creeping(rng: np.random.Generator) -> hyst.operators.Operator:
    creep = hyst.Creep([rng.uniform(0.1, 0.3)], [rng.uniform(0.05, 0.3)], DT)
    return creep @ plays(rng)


FAMILIES: dict[str, Callable[[np.random.Generator], hyst.operators.Operator]] = {
    "pi": plays,
    "rdpi": rate_dependent,
    "ramberg-osgood": lambda rng: hyst.RambergOsgood(
        *rng.uniform([0.5, 0.3, 0.8], [1.5, 1.0, 1.6])
    ),
    "mpi": lambda rng: hyst.ModifiedPrandtlIshlinskii(plays(rng), bend(rng)),
    "gpi": lambda rng: hyst.GeneralizedPrandtlIshlinskii(bend(rng), plays(rng)),
    "creep": creeping,
}


def drives() -> dict[str, Array]:
    t = np.arange(SAMPLES) * DT
    steps = np.floor(t / 0.02) * 0.02
    return {
        "two sines": 3.2 * np.sin(4.0 * np.pi * t) + np.sin(2.0 * np.pi * 7.3 * t + 1.0),
        "swelling": (3.0 + 1.2 * np.sin(0.8 * np.pi * t)) * np.sin(2.0 * np.pi * t),
        "staircase": 3.6 * np.sin(2.0 * np.pi * 1.1 * steps) + 0.4 * np.sin(17.0 * steps),
        "50 Hz": 3.2 * np.sin(100.0 * np.pi * t) + np.sin(6.0 * np.pi * t),
    }


def off(truth: hyst.operators.Operator, free: Array, rng: np.random.Generator) -> Array:
    """Give constants 20 to 40 % off, each in its own direction, that can be inverted."""
    while True:
        theta = truth.parameters().values.copy()
        theta[free] *= 1.0 + rng.choice([-1.0, 1.0], free.size) * rng.uniform(0.2, 0.4, free.size)
        theta = truth.nearest_parameters(theta)
        try:
            ModelEstimator(truth.with_parameters(theta))
        except ValueError:
            continue
        return theta


def bound_of(truth: hyst.operators.Operator, u: Array, free: Array, noise: float) -> Array:
    """Give the Cramer-Rao bound of the free constants, by central differences of the output."""
    theta, columns = truth.parameters().values, []
    for place in free.tolist():
        step = np.zeros_like(theta)
        step[place] = 1e-6 * abs(theta[place])
        ends = [truth.with_parameters(theta + sign * step)(u) for sign in (1.0, -1.0)]
        columns.append((ends[0] - ends[1]) / (2.0 * step[place]))
    jacobian = np.stack(columns, axis=1)
    shown = np.flatnonzero(jacobian.any(axis=0))
    seen = jacobian[:, shown]
    bound = np.full(free.size, np.inf)
    bound[shown] = noise * np.sqrt(np.diag(np.linalg.pinv(seen.T @ seen)))
    return bound


def one_run(
    make: Callable[[np.random.Generator], hyst.operators.Operator],
    u: Array,
    decibels: float,
    seed: int,
) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    truth = make(rng)
    held = ModelEstimator(truth).held
    names = truth.parameters().names
    free = np.array([i for i, name in enumerate(names) if name not in held])
    start = truth.with_parameters(off(truth, free, rng))
    y = truth(u)
    noise = float(np.std(y)) * 10.0 ** (-decibels / 20.0)
    noisy = (y + noise * rng.standard_normal(u.size)).tolist()
    estimator = ModelEstimator(start)
    begin = time.process_time()
    for u_k, y_k in zip(u.tolist(), noisy, strict=True):
        estimator.update(u_k, y_k)
    seconds = time.process_time() - begin
    theta, told = truth.parameters().values, estimator.knowledge
    within = (told.low <= theta) & (theta <= told.high)
    said = told.determined[free]
    bound = bound_of(truth, u, free, noise)
    error = (estimator.parameters - theta)[free] / bound
    return {
        "frozen": float(np.sqrt(np.mean((start(u) - y) ** 2))) / noise,
        "adapted": float(np.sqrt(np.mean((estimator.model(u) - y) ** 2))) / noise,
        "over bound": float(np.sqrt(np.mean(error**2))),
        "said": float(said.sum()),
        "of": float(free.size),
        "within": float((within[free] & said).sum()),
        "noise": float(estimator.innovation.consistent),
        "us": 1e6 * seconds / u.size,
    }


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--family", choices=FAMILIES)
    asked = parser.parse_args()
    print(
        f"{'family':15s}{'drive':11s}{'dB':>4s}{'frozen':>8s}{'adapted':>8s}"
        f"{'median':>8s}{'95 %':>7s}{'within':>8s}{'said':>6s}{'noise':>7s}{'us':>6s}"
    )
    total = {"within": 0.0, "said": 0.0}
    for name, make in FAMILIES.items():
        if asked.family not in (None, name):
            continue
        for drive, u in drives().items():
            for decibels in (20.0, 40.0):
                runs = [one_run(make, u, decibels, seed) for seed in range(asked.runs)]
                row = {key: np.array([run[key] for run in runs]) for key in runs[0]}
                said = max(float(row["said"].sum()), 1.0)
                for key in total:
                    total[key] += float(row[key].sum())
                print(
                    f"{name:15s}{drive:11s}{decibels:4.0f}{np.median(row['frozen']):8.2g}"
                    f"{np.median(row['adapted']):8.2g}{np.median(row['over bound']):8.2f}"
                    f"{np.quantile(row['over bound'], 0.95):7.2f}{row['within'].sum() / said:8.3f}"
                    f"{row['said'].sum() / row['of'].sum():6.2f}{row['noise'].mean():7.2f}"
                    f"{np.median(row['us']):6.1f}",
                    flush=True,
                )
    print(f"of {total['said']:.0f} bands {total['within'] / max(total['said'], 1.0):.4f} hold")


if __name__ == "__main__":
    main()

"""Ramberg-Osgood: records, steps, power evaluations, and errors over the Cramer-Rao bound.

Prints, for one machine and one run,
- the time of a sample on a smooth record, forwards and backwards, beside numpy's power alone and a
  play bank of 15,
- the time of a step from Python,
- root mean square errors of 200 identifications over the Cramer-Rao bound, fitting y and dy/du.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved, report_times

SAMPLES = 1_000_000
RUNS = 200
TRUE = (1.0, 0.02, 0.9)
NOISE = 0.01

Array = NDArray[np.float64]


def main() -> None:
    """Print all tables."""
    print_records()
    print_steps()
    print_errors()


def print_records() -> None:
    """Print nanoseconds a sample on a smooth record."""
    u = 100.0 * np.sin(np.linspace(0.0, 20.0 * np.pi, SAMPLES))
    model = hyst.RambergOsgood(*TRUE)
    plays = hyst.PrandtlIshlinskii(np.full(15, 0.1), np.linspace(3.0, 90.0, 15), p0=1.0)
    inverse, y, way = model.inverse(), model(u), np.abs(u)
    works = {
        "record": lambda: model(u),
        "record, last reversal": lambda: model.with_memory("last-reversal")(u),
        "inverse record": lambda: inverse(y),
        "15 plays": lambda: plays(u),
        "numpy power alone": lambda: way**1.9,
    }
    times = interleaved(works, seconds=3.0)
    print(f"smooth record of {SAMPLES} samples, median")
    for name, each in times.items():
        median = float(np.median(each)) / SAMPLES
        print(f"  {name:24s} {1e9 * median:8.2f} ns a sample  {1e-6 / median:8.1f} M samples/s")
    inverse_over = report_times(
        "inverse over forward", times, "inverse record", "record", better="smaller"
    )
    print(f"  inverse record / record {inverse_over:.2f}")
    power_over = report_times("numpy power over forward", times, "numpy power alone", "record")
    print(f"  numpy power / record {power_over:.2f}")


def print_steps() -> None:
    """Print nanoseconds of a step called from Python."""
    u = (100.0 * np.sin(np.linspace(0.0, 20.0, 20_000))).tolist()
    model = hyst.RambergOsgood(*TRUE)
    y = model(u).tolist()
    forward, backward = model.stepper(), model.inverse().stepper()

    def run(step: hyst.operators.Stepper, values: list[float]) -> None:
        for value in values:
            step(value)

    times = interleaved(
        {"step": lambda: run(forward, u), "inverse step": lambda: run(backward, y)}, seconds=1.0
    )
    for name, each in times.items():
        print(f"{name} from Python {1e9 * float(np.median(each)) / len(u):8.1f} ns")


def print_errors() -> None:
    """Print root mean square errors over the Cramer-Rao bound."""
    u = 100.0 * np.sin(np.linspace(0.0, 4.0 * np.pi, 500, endpoint=False))
    y = hyst.RambergOsgood(*TRUE)(u)
    bound = cramer_rao_bound(u, NOISE * float(np.ptp(y)))
    print(f"rms errors of {RUNS} identifications over the Cramer-Rao bound, 2 periods, 1 % noise")
    for regression in ("output", "slope"):
        found = [identified(u, y, regression, seed) for seed in range(RUNS)]
        errors = np.array([each - TRUE for each in found if each is not None])
        share = np.sqrt(np.mean(errors**2, axis=0)) / bound
        failed = RUNS - len(errors)
        print(f"  {regression:8s} c1, c2, c3: {np.round(share, 2)}, no result in {failed} runs")


def identified(u: Array, y: Array, regression: str, seed: int) -> Array | None:
    """Give c1, c2, c3 from a noisy record, or None where the noise hides them."""
    noise = NOISE * np.ptp(y) * np.random.default_rng(seed).normal(size=y.size)
    try:
        result = hyst.identify(
            hyst.Record(u, y + noise, 1e-3),
            family="ramberg-osgood",
            regression=regression,
            **({"signal_to_noise": 0.3} if regression == "slope" else {}),
            delay=0,
            start=0,
        )
    except hyst.NotIdentifiableError:
        return None
    return result.parameter_values[:3]


def cramer_rao_bound(u: Array, sigma: float) -> Array:
    """Give the least standard deviations of c1, c2, c3 with a free offset."""
    jacobian = np.column_stack([hyst.RambergOsgood(*TRUE).jacobian(u), np.ones(u.size)])
    return np.asarray(sigma * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))[:3])


if __name__ == "__main__":
    main()

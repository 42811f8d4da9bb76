"""Identification: time of the solvers, and errors relative to the Cramer-Rao bound.

Prints, for one machine and one run,
- the time of the weights of a 10-play model with given radii against scipy's nnls on the matrix,
- the time of the whole identification of a record,
- root mean square errors of 200 identifications over the Cramer-Rao bound.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

import hyst
from hyst.identification.data import prepare
from hyst.identification.play_bank import bank_matrix
from hyst.identification.weights import fit_weights

RUNS = 200
NOISE = 0.01
TRUE = hyst.PrandtlIshlinskii(p=[0.5, 0.4, 0.3, 0.2], r=[0.08, 0.22, 0.43, 0.71], p0=1.0)
OFFSET = 0.3


def main() -> None:
    """Print all tables."""
    print_times()
    print_errors()


def print_times() -> None:
    """Print the time of weights and of a whole identification."""
    record = simulated_record(np.random.default_rng(1), samples=8000)
    data = prepare(record, "auto", 0)
    r = data.half_range * np.arange(1, 11) / 11
    ours = median_time(lambda: fit_weights(data, r), 30)
    y = data.measured()
    peer = median_time(lambda: nnls(with_offset(bank_matrix(data, r)), y), 30)
    print("weights of a 10-play model, radii given, 8000 samples")
    print(f"  streamed Gram and NNLS  {1e3 * ours:8.2f} ms")
    print(f"  matrix and scipy nnls   {1e3 * peer:8.2f} ms   ratio {peer / ours:.1f}")
    whole = median_time(lambda: hyst.identify(record), 1)
    print(f"identify, all families and sizes, 8000 samples: {whole:.2f} s")


def with_offset(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Append an offset of either sign."""
    one = np.ones((len(matrix), 1))
    return np.hstack([matrix, one, -one])


def print_errors() -> None:
    """Print root mean square errors over the Cramer-Rao bound, parameter by parameter."""
    rng = np.random.default_rng(2)
    found, claimed = [], []
    for _ in range(RUNS):
        result = hyst.identify(simulated_record(rng), family="pi", plays=4, delay=0)
        found.append(result.parameter_values)
        claimed.append(result.standard_errors)
    truth = np.concatenate([[TRUE.p0], TRUE.p, TRUE.r, [OFFSET]])
    rms = np.sqrt(np.mean((np.array(found) - truth) ** 2, axis=0))
    bound = cramer_rao_bound(simulated_record(np.random.default_rng(2)))
    typical = np.median(np.array(claimed), axis=0)
    print(f"errors of {RUNS} identifications (4 plays, 4000 samples, white noise {NOISE})")
    print(f"  {'parameter':28s} {'rms error':>10s} {'bound':>10s} {'ratio':>6s} {'claimed/rms':>12s}")
    for name, error, least, said in zip(
        result.parameter_names, rms, bound, typical, strict=True
    ):
        print(f"  {name:28s} {error:10.2e} {least:10.2e} {error / least:6.2f} {said / error:12.2f}")
    ratio = rms / bound
    print(f"  largest ratio: weights {ratio[:5].max():.2f}, radii {ratio[5:9].max():.2f}")
    print("  (200 runs know a ratio to 5 %, so the largest of five is 1.08 by chance alone)")


def simulated_record(rng: np.random.Generator, samples: int = 4000) -> hyst.Record:
    """Give a decaying and growing sine through the true model, with white noise."""
    t = np.arange(samples) * 1e-3
    u = (1.0 - 0.6 * np.sin(np.pi * t / t[-1])) * np.sin(2 * np.pi * 5.0 * t + 0.3)
    y = TRUE(u) + OFFSET + NOISE * rng.standard_normal(samples)
    return hyst.Record(u, y, dt=1e-3)


def cramer_rao_bound(record: hyst.Record) -> NDArray[np.float64]:
    """Give the least standard deviation any unbiased estimator can have, over the samples used."""
    window = prepare(record, "auto", 0).windows()[0]
    jacobian = TRUE.jacobian(record.u)[window]
    jacobian = np.hstack([jacobian, np.ones((len(jacobian), 1))])
    return np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian))) * NOISE


def median_time(work: Callable[[], object], repeats: int) -> float:
    """Give the median time of a call in seconds."""
    times = []
    for _ in range(repeats):
        before = time.perf_counter()
        work()
        times.append(time.perf_counter() - before)
    return statistics.median(times)


if __name__ == "__main__":
    main()

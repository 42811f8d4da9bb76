"""Many models, many records: one call against a loop over calls, and against numba.

Prints microseconds a model and how many times longer a loop in Python and one in numba take, for
10 plays, one thread: many models on one record, or on one record each, and their loss gradients.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved, ratio, report_times

Array = NDArray[np.float64]

PLAYS = 10
MODEL = hyst.PrandtlIshlinskii(np.full(PLAYS, 0.1), np.arange(1, PLAYS + 1) / (PLAYS + 1), 0.3)
OURS = "one call"


def outputs(u: Array, theta: Array) -> Array:
    """What numba compiles: plays one after the other, sample by sample."""
    y = np.empty((theta.shape[0], u.shape[1]))
    n = (theta.shape[1] - 1) // 2
    z = np.empty(n)
    for m in range(theta.shape[0]):
        z[:] = 0.0
        record = u[m % u.shape[0]]
        for k in range(record.size):
            total = theta[m, 0] * record[k]
            for i in range(n):
                r = theta[m, 1 + n + i]
                z[i] = max(record[k] - r, min(record[k] + r, z[i]))
                total += theta[m, 1 + i] * z[i]
            y[m, k] = total
    return y


def works_of(models: int, samples: int, one_record: bool) -> dict[str, Callable[[], object]]:
    """Give the same work in one call, in a loop in Python, and in numba."""
    rng = np.random.default_rng(1)
    u = np.cumsum(rng.normal(size=(1 if one_record else models, samples)), axis=1) * 0.05
    theta = MODEL.parameters().values * rng.uniform(0.9, 1.1, (models, 1))
    records = u[0] if one_record else u
    each = [MODEL.with_parameters(row) for row in theta]
    works: dict[str, Callable[[], object]] = {
        OURS: lambda: hyst.evaluate_batch(MODEL, records, theta),
        "loop over models": lambda: [
            model(u[0 if one_record else i]) for i, model in enumerate(each)
        ],
        "and making them": lambda: [
            MODEL.with_parameters(row)(u[0 if one_record else i]) for i, row in enumerate(theta)
        ],
        "loss gradients": lambda: hyst.batch_loss_gradient(
            MODEL, u[0] if one_record else u, u, theta
        ),
    }
    if importlib.util.find_spec("numba") is not None:
        import numba

        compiled = numba.njit(outputs)
        works["numba"] = lambda: compiled(u, theta)
    return works


def main() -> None:
    """Print the table."""
    print("Numbers after names: how many times longer they take than one call.\n")
    print("| models | samples | records | us a model | times ours |\n|---|---|---|---|---|")
    for models, samples in ((1000, 100), (1000, 500), (200, 5000)):
        for one_record in (True, False):
            times = interleaved(works_of(models, samples, one_record))
            cells = ", ".join(f"{name} {ratio(times, name, OURS):.3g}" for name in times)
            cost = np.median(times[OURS]) / models * 1e6
            records = "one" if one_record else "one each"
            for name in times.keys() & {"loop over models", "numba"}:
                told = f"{name} over one call, {models} models, {samples} samples, {records}"
                report_times(told, times, name, OURS)
            print(f"| {models} | {samples} | {records} | {cost:.3g} | {cells} |", flush=True)


if __name__ == "__main__":
    main()

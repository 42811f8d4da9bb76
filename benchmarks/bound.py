"""Every family on its own noisy record: errors of its constants over the Cramer-Rao bound.

The actuators are those of the contract tests (tests/reference/family_examples.py). The bound is the
least standard deviation that any unbiased estimate can have, from the derivatives of the true
model over the samples that are used. Printed are the root mean square of the ratio over all
constants, the largest, and the constant that has it; ``--runs N`` and ``--family a,b`` choose. At
40 runs a ratio is known to 11 %, so the largest of eight is 1.2 by chance alone.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

import hyst
from hyst.identification.fit.problem import Evaluation
from hyst.identification.options import Options
from hyst.identification.progress import Progress
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.search import Found, find

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
from reference.family_examples import FamilyExample, family_example

Array = NDArray[np.float64]

RUNS = 100
SECONDS = 60.0
"""For the runs of a family, after the first 40."""

FEWEST_RUNS = 40
BEYOND_ROUNDING = 1e-12


def main() -> None:
    """Print a line for each family."""
    asked = _asked()
    names = asked.family.split(",") if asked.family else list(hyst.families)
    print(f"{'family':18s} {'runs':>5s} {'rms':>6s} {'most':>6s}  of")
    for name in names:
        try:
            print(line_of(name, asked.runs), flush=True)
        except (hyst.HystError, AttributeError, ValueError) as error:
            print(f"{name:18s} no bound: {error}", flush=True)


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks bound")
    parser.add_argument("benchmarks", nargs="*")
    parser.add_argument("--family", default="")
    parser.add_argument("--runs", type=int, default=RUNS)
    return parser.parse_args(sys.argv[1:])


def line_of(name: str, runs: int) -> str:
    """Identify from noisy records and compare the scatter around the truth with the bound."""
    example = family_example(name)
    names, truth, bound = cramer_rao_bound(name, example)
    errors, failed, stop = [], 0, time.perf_counter() + SECONDS
    for seed in range(runs):
        if seed >= FEWEST_RUNS and time.perf_counter() > stop:
            break
        records = example.records(example.noise, 1000 + seed)
        try:
            found = hyst.identify(records, family=name, delay=0, **example.options)
        except (hyst.NotIdentifiableError, hyst.SolverError):
            failed += 1
            continue
        values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
        errors.append([values[each] - at for each, at in zip(names, truth, strict=True)])
    ratio = np.sqrt(np.mean(np.square(errors), axis=0)) / bound
    told = np.flatnonzero(np.isfinite(ratio))
    most = told[ratio[told].argmax()]
    failures = f"; {failed} runs gave no result" if failed else ""
    return (
        f"{name:18s} {len(errors):5d} {np.sqrt(np.mean(ratio[told] ** 2)):6.2f} {ratio[most]:6.2f}"
        f"  {names[most]} ({told.size} of {len(names)} constants{failures})"
    )


def cramer_rao_bound(name: str, example: FamilyExample) -> tuple[tuple[str, ...], Array, Array]:
    """Give names, true values and least standard deviations of the constants a family estimates.

    A constant that lies on a bound, or that the drive does not determine, has none: NaN.
    """
    found = _without_noise(name, example)
    fit, data = found.fit, found.data
    parametrization, theta = fit.parametrization, fit.solution.theta
    estimates = fit.family.estimates(fit)
    sigma = np.concatenate(
        [
            np.full(length, example.noise * np.ptp(record.y))
            for length, record in zip(data.lengths(), data.records, strict=True)
        ]
    )
    jacobian = Evaluation(data, parametrization).jacobian(theta) / sigma[:, None]
    inside = parametrization.inside(theta)
    unit = np.linalg.norm(jacobian, axis=0)
    unit[unit == 0.0] = 1.0
    basis = np.eye(theta.size)[:, inside]
    if parametrization.gauges is not None:
        held = parametrization.gauges(theta)[1][:, inside] / unit[inside]
        basis = basis @ scipy.linalg.null_space(held)
    _, size, directions = np.linalg.svd(jacobian / unit @ basis, full_matrices=False)
    known = size > BEYOND_ROUNDING * size.max()
    spread = (basis @ directions[known].T) / size[known]
    bound = np.linalg.norm((estimates.by_theta / unit) @ spread, axis=1)
    open_ones = np.abs(estimates.by_theta / unit @ basis @ directions[~known].T).sum(axis=1) > 0.0
    bound[open_ones | (bound == 0.0)] = np.nan
    return estimates.names, estimates.values, bound


def _without_noise(name: str, example: FamilyExample) -> Found:
    records = tuple(example.records())
    family = hyst.families.make(name, example.options)
    nothing = (None,) * len(records)
    wanted = Options((), Progress(), 0, "auto", 200, False)
    return find(Cleaned(records, nothing, nothing), (family,), wanted)


if __name__ == "__main__":
    main()

"""Laws of the rate, maps and noise of the drive: rate-dependent plays found from other plants.

Plants are written with the equations of S4 in NumPy alone, as the tests have them. Prints
- which law ``rate="auto"`` chooses, and how its constants scatter over their standard errors,
- the error of the trajectory inverse of what was found over that of the true model,
- what is left of asymmetric plants without and with a map,
- what noise of 0.06 % of the drive does with and without the filter.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.models import RateCurve, RateDependentPrandtlIshlinskii

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from reference import rate_laws as plants
from reference.rate_dependent_plays import ACTUATOR, DT

Array = NDArray[np.float64]

RUNS = 20
TRUTH = {
    "linear": {"beta": plants.BETA},
    "sqrt": {"square_root": plants.SQUARE_ROOT},
    "rational": {"slope": plants.SLOPE, "rate": plants.BEND},
    "exponential": {"slope": plants.SLOPE, "rate": plants.BEND},
}
CURVES = {
    "linear": RateCurve(plants.BETA),
    "sqrt": RateCurve.square_root(plants.SQUARE_ROOT, 1e5),
    "rational": RateCurve.saturating(plants.SLOPE, plants.BEND, 1e5),
    "exponential": RateCurve.saturating(plants.SLOPE, plants.BEND, 1e5, "exponential"),
}
NAMES = ("p0", "p[1]", "p[2]", "p[3]", "r[1]", "beta")
VALUES = (ACTUATOR["p0"], *ACTUATOR["p"], ACTUATOR["r"][0], plants.BETA)


def main() -> None:
    """Print all tables."""
    print_laws()
    print_inverses()
    print_maps()
    print_drive_noise()


def identify(records: list[hyst.Record], **options: object) -> hyst.Identified:
    """Identify three plays without asking for a delay."""
    return hyst.identify(records, family="rdpi", plays=3, delay=0, **options)


def print_laws() -> None:
    """Print the law chosen and the scatter of its constants."""
    print(f"law chosen among all, {RUNS} runs, noise 0.06 % of the output's range")
    print("  plant         chosen   within 2 s.e.   rms error / s.e.")
    for name, truth in TRUTH.items():
        z, right = [], 0
        for seed in range(RUNS):
            found = identify(plants.records(plants.LAWS[name], seed), rate="auto")
            told = plants.estimates(found)
            if truth.keys() <= told.keys():
                right += 1
                z += [(told[key][0] - value) / told[key][1] for key, value in truth.items()]
        rms = np.sqrt(np.mean(np.square(z)))
        print(f"  {name:12s} {right:3d}/{RUNS} {np.mean(np.abs(z) <= 2.0):13.2f} {rms:16.2f}")


def print_inverses() -> None:
    """Print the error of the trajectory inverse over that of the true model."""
    print(
        "\ntrajectory inverse of models found and of the true one, of 25, five runs of each noise"
    )
    print("  plant         noise   f [Hz]   rms: true   found (median, worst)   max: true   found")
    for name, noise in product(("sqrt", "rational", "exponential"), (0.05, 0.005)):
        models = [
            identify(plants.records(plants.LAWS[name], seed, noise=noise), rate="auto").model
            for seed in range(5)
        ]
        plays = RateDependentPrandtlIshlinskii(
            ACTUATOR["p"], ACTUATOR["r"], CURVES[name], DT, ACTUATOR["p0"]
        )
        true = hyst.Affine(1.0, plants.OFFSET) @ plays
        for frequency in (20.0, 60.0, 100.0):
            y_ref = plants.sine(frequency, 3.0, DT, 25.0) + plants.OFFSET
            errors = []
            for model in (true, *models):
                done = hyst.compensation.invert_trajectory(
                    model.at_sample_time(DT), y_ref, "trajectory", allow_unconverged=True
                )
                errors.append(plants.plant(done.u, DT, plants.LAWS[name]) - y_ref)
            rms = [float(np.std(each)) for each in errors]
            most = [float(np.abs(each).max()) for each in errors]
            print(
                f"  {name:12s} {noise:6g} {frequency:8.0f} {rms[0]:11.4f} "
                f"{np.median(rms[1:]):10.4f} "
                f"{max(rms[1:]):10.4f} {most[0]:13.4f} {np.median(most[1:]):9.4f}"
            )


def bent(y: Array) -> Array:
    """A map with two knots."""
    return y + 0.15 * np.maximum(y - 10.0, 0.0) - 0.2 * np.minimum(y + 10.0, 0.0)


def curved(y: Array) -> Array:
    """A map without knots."""
    return y + 0.002 * y**2


def print_maps() -> None:
    """Print what is left of asymmetric plants."""
    print("\nasymmetric plants, linear law: rms left, % of the output's range (noise 0.06)")
    print("  map                    without   dead-zone   envelope")
    for name, map_ in (("two knots", bent), ("square", curved)):
        for where in ("after", "before"):
            made = plants.records(plants.LAWS["linear"], 1, **{where: map_})
            left = [
                identify(made, map=each, map_knots=9).metrics["training"].rms_percent
                for each in ("none", "dead-zone", "envelope")
            ]
            print(f"  {name:10s} {where:8s} " + "".join(f"{each:11.3f}" for each in left))


def print_drive_noise() -> None:
    """Print the errors of constants with noise on the measured drive."""
    print(f"\nnoise of 0.06 % on the drive, {RUNS} runs: rms error, % (over its standard error)")
    print("  drive      filter   " + "".join(f"{name:>15s}" for name in NAMES))
    runs = [(1.0, 1.7, 1e-4), (50.0, 10.0, 1e-4), (100.0, 10.0, 1e-4)]
    shapes: tuple[Callable[..., Array], ...] = (plants.sine, plants.triangle)
    for shape, rate_filter in product(shapes, ("none", "auto")):
        misses, errors = [], []
        for seed in range(RUNS):
            made = plants.records(
                plants.LAWS["linear"], seed, drive_noise=0.05, shape=shape, runs=runs
            )
            told = plants.estimates(identify(made, rate_filter=rate_filter))
            misses.append([told[n][0] - v for n, v in zip(NAMES, VALUES, strict=True)])
            errors.append([told[n][1] for n in NAMES])
        z = np.array(misses) / np.array(errors)
        percent = 100.0 * np.sqrt(np.mean(np.square(misses), axis=0)) / np.array(VALUES)
        rms, inside = np.sqrt(np.mean(np.square(z), axis=0)), np.mean(np.abs(z[:, -1]) <= 2.0)
        cells = "".join(f"{a:8.2f} ({b:4.2f})" for a, b in zip(percent, rms, strict=True))
        print(f"  {shape.__name__:10s} {rate_filter:8s} {cells}   beta within 2 s.e. {inside:.2f}")


if __name__ == "__main__":
    main()

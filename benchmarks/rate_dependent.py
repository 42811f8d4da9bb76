"""Rate-dependent plays: how inversion scales, and identification against the Cramer-Rao bound.

Prints, for one machine and one run,
- what the trajectory inversion leaves for every objective, what the drive pays, and what is left
  where the plant has a lag or other constants that the model does not know,
- what explicit inverse, preview and trajectory leave of the example, and what a sample costs,
- the time of the trajectory inversion over the number of samples,
- coverage of the standard errors and errors over the bound, of 100 identifications from records at
  1, 50 and 100 Hz with 1 % noise.
The error of every inversion over frequency is what ``hyst reproduce s4`` prints.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.compensation import invert_trajectory
from hyst.studies.s4_rate_dependent import ACTUATOR, DT, EXAMPLE, example_reference

Array = NDArray[np.float64]

RUNS = 100
NOISE = 0.01
OFFSET = 0.3
PREVIEWS = (5, 10, 20, 40)
FREQUENCIES = ((1.0, 1.7), (50.0, 10.0), (100.0, 20.0))
"""Hz, and periods of each record."""


def main() -> None:
    """Print all tables."""
    print_trades()
    print_previews()
    print_times()
    print_identification()


def print_trades() -> None:
    """Print errors, size and roughness of the drive for every objective."""
    gain = EXAMPLE.p0 + float(EXAMPLE.p.sum())
    asked = {
        "rms": {},
        "rms, roughness 0": {"roughness": 0.0},
        "rms, roughness 0.3 of the gain": {"roughness": 0.3 * gain},
        "largest": {"objective": "largest"},
        "largest, roughness 0": {"objective": "largest", "roughness": 0.0},
    }
    print("trajectory of the example, dt = 0.1 ms; bends are second differences of the drive")
    print(
        "   Hz  asked for                          rms  largest   size  bends, rms  turns"
        "  lag 0.05  lag 0.42  2 % off  CPU s per 1000"
    )
    for f in (10.0, 30.0, 60.0, 100.0, 200.0):
        y_ref = example_reference(f, DT)
        for name, how in asked.items():
            begin = time.process_time()
            done = invert_trajectory(EXAMPLE, y_ref, "trajectory", allow_unconverged=True, **how)
            took = 1e3 * (time.process_time() - begin) / y_ref.size
            away = [rms(late(lag)(done.u) - y_ref) for lag in (0.05, 0.42)]
            away.append(rms(np.array([other(seed)(done.u) - y_ref for seed in range(4)])))
            print(
                f"  {f:3g}  {name:30s} {done.rms:8.4f} {done.max_abs:8.4f} {done.command_size:6.2f}"
                f" {done.roughness:11.3f} {done.reversals:6d}"
                f" {away[0]:9.3f} {away[1]:9.3f} {away[2]:8.3f} {took:15.2f}"
            )
    print()


def late(samples: float) -> hyst.operators.Operator:
    """Give the example behind an amplifier that is late by a share of a sample."""
    return EXAMPLE @ hyst.Delay(samples, DT)


def other(seed: int) -> hyst.RateDependentPrandtlIshlinskii:
    """Give the example with constants that are 2 % off."""
    random = np.random.default_rng(seed)
    p, r = (x * (1.0 + 0.02 * random.normal(size=x.size)) for x in (EXAMPLE.p, EXAMPLE.r))
    beta = EXAMPLE.beta * (1.0 + 0.02 * random.normal())
    return hyst.RateDependentPrandtlIshlinskii(p, r, beta, DT, EXAMPLE.p0)


def rms(error: Array) -> float:
    """Give the root mean square."""
    return float(np.sqrt(np.mean(error**2)))


def print_previews() -> None:
    """Print error, drive and time of inverses that know more and more of the reference."""
    print("the example, dt = 0.1 ms, middle of three periods; us are those of the processor")
    print("  f [Hz]   inverse            max     rms   drive   us a sample   us, 10 plays")
    ten = hyst.RateDependentPrandtlIshlinskii(
        np.full(10, 0.15), 1.5 * np.arange(1.0, 11.0), EXAMPLE.beta, DT, p0=0.5
    )
    for f in (10.0, 30.0, 60.0, 100.0):
        y_ref = example_reference(f, DT)
        inverses = {"explicit": (EXAMPLE.explicit_inverse(), ten.explicit_inverse(), 0)}
        for n in PREVIEWS:
            inverses[f"preview of {n}"] = EXAMPLE.inverse(preview=n), ten.inverse(preview=n), n
        for name, (inverse, other, late) in inverses.items():
            u = inverse(y_ref)
            error = EXAMPLE(u)[late:] - y_ref[: y_ref.size - late]
            costs = cost(inverse, y_ref), cost(other, y_ref)
            print_row(f, name, error, u[late:], costs)
        u = invert_trajectory(EXAMPLE, y_ref, "trajectory", allow_unconverged=True).u
        print_row(f, "trajectory", EXAMPLE(u) - y_ref, u, (np.nan, np.nan))


def print_row(f: float, name: str, error: Array, u: Array, costs: tuple[float, float]) -> None:
    """Print what one inverse does over the middle period."""
    third = round(1.0 / f / DT)
    middle, moved = error[third : 2 * third], u[third : 2 * third]
    largest, rms = np.abs(middle).max(), np.sqrt(np.mean(middle**2))
    print(
        f"  {f:6g}   {name:14s} {largest:7.3f} {rms:7.3f} {np.abs(moved).max():7.1f} "
        f"{costs[0]:13.2f} {costs[1]:14.2f}"
    )


def cost(inverse: hyst.Operator, y_ref: Array) -> float:
    """Give the least time of the processor for a sample, us, of some long runs."""
    long = np.tile(y_ref, 1 + 6000 // y_ref.size)
    times = []
    for _ in range(5):
        begin = time.process_time()
        inverse(long)
        times.append(time.process_time() - begin)
    return 1e6 * min(times) / long.size


def print_times() -> None:
    """Print the time of inversions over the number of samples."""
    print("inversion of the example, dt = 0.1 ms, three periods")
    print("  samples   trajectory [s]   a sample [us]   max error")
    for f in (60.0, 30.0, 3.0, 0.3):
        y_ref = example_reference(f, DT)
        whole, done = timed(y_ref, "trajectory")
        a_sample = 1e6 * whole / y_ref.size
        print(f"  {y_ref.size:7d} {whole:16.2f} {a_sample:15.0f} {done.max_abs:11.3g}")


def timed(y_ref: Array, method: str) -> tuple[float, hyst.compensation.Compensation]:
    """Time one inversion."""
    begin = time.perf_counter()
    done = invert_trajectory(EXAMPLE, y_ref, method, allow_unconverged=True)
    return time.perf_counter() - begin, done


def print_identification() -> None:
    """Print coverage and errors over the Cramer-Rao bound, parameter by parameter."""
    model = hyst.Affine(1.0, OFFSET) @ ACTUATOR
    inputs = [
        40.0 * np.sin(2.0 * np.pi * f * np.arange(round(n / f / DT)) * DT) for f, n in FREQUENCIES
    ]
    outputs = [model(u) for u in inputs]
    noise = NOISE * float(np.ptp(outputs[0]))
    random = np.random.default_rng(1)
    values, errors, names, used = [], [], (), ()
    for _ in range(RUNS):
        records = [
            hyst.Record(u, y + noise * random.normal(size=u.size), dt=DT)
            for u, y in zip(inputs, outputs, strict=True)
        ]
        found = hyst.identify(records, family="rdpi", plays=3, delay=0)
        values.append(found.parameter_values)
        errors.append(found.standard_errors)
        names, used = found.parameter_names, found.used
    free = [i for i, name in enumerate(model.parameters().names) if name != "affine.gain"]
    miss = np.array(values) - model.parameters().values[free]
    blocks = [model.jacobian(u)[w.start : w.stop, free] for u, w in zip(inputs, used, strict=True)]
    bound = noise * cramer_rao(np.concatenate(blocks))
    print(f"\nidentification from 1, 50 and 100 Hz, {RUNS} runs, {100 * NOISE:g} % noise")
    print("  parameter                                 within 2 s.e.   rms error / bound")
    inside = (np.abs(miss) <= 2.0 * np.array(errors)).mean(axis=0)
    ratio = np.sqrt(np.mean(miss**2, axis=0)) / bound
    for name, share, each in zip(names, inside, ratio, strict=True):
        print(f"  {name:40s} {share:14.2f} {each:19.2f}")


def cramer_rao(jacobian: Array) -> Array:
    """Bound for radii at multiples of the first, for noise of variance 1."""
    layout = np.zeros((9, 7))
    layout[:4, :4] = np.eye(4)
    layout[4:7, 4] = 1.0, 2.0, 3.0
    layout[7, 5] = layout[8, 6] = 1.0
    by_theta = jacobian @ layout
    covariance = layout @ np.linalg.inv(by_theta.T @ by_theta) @ layout.T
    return np.sqrt(np.diag(covariance))


if __name__ == "__main__":
    main()

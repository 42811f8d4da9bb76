"""Hysteresis before dynamics, identified from drives a lab can apply, everything automatic.

Every identification is ``hyst.identify(record, family="hammerstein", hysteresis="pi")``. ``other``
is the error on a drive it has not seen, a multisine below the resonances, in % of the output's rms;
``bound`` that of a fit of the plant's own structure which starts from the truth, which no method is
expected to fall below. Seconds are processor time.

``python -m benchmarks hammerstein_drives [--part drives,orders,two-mode,bouc-wen,time,bad]
[--runs N] [--only TEXT]``: seeds and actuators of the orders.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator

import numpy as np
import scipy.optimize
import scipy.signal
from numpy.typing import NDArray

import hyst
from benchmarks.resonant_records import (
    FRONT,
    SAMPLES,
    Run,
    Stage,
    drives,
    error_percent,
    fitted_from_truth,
    identified,
    measured,
    multisine,
    stage,
    with_feedback,
)
from hyst.identification.families.hammerstein import fit_markov, realize
from hyst.studies import s1_robust_tracking as s1

Array = NDArray[np.float64]

RUNS = 20


def main() -> None:
    """Print the parts that are asked for."""
    options = _options()
    if options.long:
        return _long(options.long)
    parts: dict[str, Callable[[argparse.Namespace], None]] = {
        "drives": by_drive,
        "orders": by_order,
        "two-mode": two_mode_actuator,
        "bouc-wen": bouc_wen,
        "time": times,
        "bad": bad_input,
    }
    for name in options.part.split(",") if options.part else parts:
        print(f"### {name}\n", flush=True)
        parts[name](options)
        print(flush=True)
    return None


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser("hammerstein_drives")
    parser.add_argument("--part", default="")
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--only", default="")
    parser.add_argument("--long", type=int, default=0, help=argparse.SUPPRESS)
    return parser.parse_known_args(sys.argv[1:])[0]


def by_drive(_: argparse.Namespace) -> None:
    """Print what each drive gives of one actuator."""
    plant = stage(FRONT, [(200.0, 0.03)], 1e-4, delay=3)
    other = multisine(1e-4, 1.0, 100.0, 10.0, 99)
    print("200 Hz, damping 0.03, 10 kHz, 3 samples of delay, five plays, 40 dB, 20,000 samples\n")
    print(f"{'drive':28s} {'own [%]':>8s} {'other':>7s} {'bound':>7s}  dynamics, verdict")
    for name, u in drives():
        record = measured(plant, u, 40.0, 1)
        run = identified(record)
        if run.found is None:
            print(f"{name:28s} {run.refused}", flush=True)
            continue
        bound = error_percent(fitted_from_truth(plant, record), plant, other)
        print(
            f"{name:28s} {error_percent(run.found.model, plant, u):8.3f} "
            f"{error_percent(run.found.model, plant, other):7.3f} {bound:7.3f}  {_told(run)}",
            flush=True,
        )


def _told(run: Run) -> str:
    """Tell dynamics, verdict, yardstick and time of an identification in a line."""
    found = run.found
    roots = ", ".join(
        f"{each.frequency:.3f} Hz {each.damping:.5f}{'' if each.is_determined else ' (open)'}"
        for each in found.resonances
    )
    real = f"{len(found.real_poles)} real" if found.real_poles else ""
    constants = len(found.hysteresis.parameters())
    return (
        f"n {found.dynamics.order}, late {found.dynamics.delay}, "
        f"{', '.join(each for each in (roots, real) if each)}; {constants} constants; "
        f"{found.verdict.level}, ratio {found.yardstick.ratio:.2f}; {run.seconds:.1f} s"
    )


def _ordered() -> Iterator[tuple[str, Stage, float, Callable[[int], Array], Array]]:
    """Give actuators, noise in dB, drives by seed, and the other drive."""
    narrow = stage(FRONT, [(200.0, 0.03), (520.0, 0.03)], 1e-4, delay=3)
    other = multisine(1e-4, 1.0, 100.0, 10.0, 99)
    yield "200 + 520 Hz, 1-1000 Hz", narrow, 40.0, lambda k: multisine(1e-4, 1, 1e3, 10.0, k), other
    dt, other = 1e-3, multisine(1e-3, 0.05, 30.0, 10.0, 99)
    plants = {
        "100 + 270 Hz": stage(FRONT, [(100.0, 0.05), (270.0, 0.03)], dt),
        "60 + 150 + 320 Hz": stage(FRONT, [(60.0, 0.03), (150.0, 0.03), (320.0, 0.03)], dt),
        "100 Hz, notch at 150": stage(
            FRONT, [(100.0, 0.05)], dt, zeros=(150.0, 0.01), poles=(180.0, 0.05)
        ),
    }
    for name, plant in plants.items():
        for decibels in (30.0, 40.0, 60.0):
            yield name, plant, decibels, lambda k: multisine(dt, 0.0, 500.0, 10.0, k), other


def by_order(options: argparse.Namespace) -> None:
    """Print how often the order is found, and errors over those of fits from the truth."""
    print(
        f"five plays, 20,000 samples, {options.runs} seeds of phases and noise; rms over the runs\n"
    )
    print(
        f"{'actuator':24s} {'noise':>6s} {'right':>8s} {'other':>8s} {'bound':>8s} {'ratio':>6s} "
        f"{'median':>6s} {'worst':>6s} {'own':>6s} {'s':>5s}  orders"
    )
    for name, plant, decibels, drive, other in _ordered():
        if options.only not in f"{name} {decibels:g} dB":
            continue
        rows, orders, seconds = [], Counter[str](), []
        for seed in range(options.runs):
            u = drive(seed + 100)
            record = measured(plant, u, decibels, seed)
            run = identified(record)
            seconds.append(run.seconds)
            if run.found is None:
                orders["refused"] += 1
                continue
            orders[f"{run.found.dynamics.order}"] += 1
            bound = fitted_from_truth(plant, record)
            rows.append(
                [
                    error_percent(each, plant, v)
                    for v in (other, u)
                    for each in (run.found.model, bound)
                ]
            )
        _print_errors(f"{name:24s} {decibels:3g} dB", np.array(rows), seconds, orders, plant.order)


def _print_errors(
    name: str, rows: Array, seconds: list[float], orders: Counter[str], right: int
) -> None:
    """Print errors found and of the bound, on the other drive and on its own."""
    errors = np.sqrt(np.mean(np.square(rows), axis=0))
    ratios = rows[:, 0] / rows[:, 1]
    told = ", ".join(f"{order}: {count}" for order, count in orders.most_common())
    print(
        f"{name} {orders[str(right)]:2d} of {orders.total():2d} "
        f"{errors[0]:8.4f} {errors[1]:8.4f} {errors[0] / errors[1]:6.2f} "
        f"{np.median(ratios):6.2f} {ratios.max():6.2f} {errors[2] / errors[3]:6.2f} "
        f"{np.median(seconds):5.1f}  {told}",
        flush=True,
    )


def two_mode_actuator(_: argparse.Namespace) -> None:
    """Print the actuator of S1: strong, stiffening hysteresis before two modes."""
    b = np.array([s1.W1**2 * s1.W2**2])
    first, second = [1.0, 2.0 * s1.Z1 * s1.W1, s1.W1**2], [1.0, 2.0 * s1.Z2 * s1.W2, s1.W2**2]
    n, d, _dt = scipy.signal.cont2discrete((b, np.polymul(first, second)), 1e-3)
    plant = Stage(s1.PLAYS, n.ravel() * d.sum() / n.sum(), d, 1e-3)
    rng = np.random.default_rng(3)
    given = {
        "multisine": multisine(1e-3, 0.0, 500.0, 50.0, 3),
        "levels held 5": np.repeat(rng.uniform(-50.0, 50.0, SAMPLES // 5), 5),
        "levels, every sample": rng.uniform(-50.0, 50.0, SAMPLES),
    }
    other = multisine(1e-3, 0.05, 50.0, 48.0, 99)
    print("actuator of S1 (eq. 41, plays of sec. 5.2), 1 kHz, amplitude 50, 50 dB\n")
    for name, u in given.items():
        record = measured(plant, u, 50.0, 1)
        run = identified(record)
        if run.found is None:
            print(f"{name:22s} {run.refused}", flush=True)
            continue
        bound = fitted_from_truth(plant, record)
        print(
            f"{name:22s} own {error_percent(run.found.model, plant, u):.3f} "
            f"({error_percent(bound, plant, u):.3f}), other "
            f"{error_percent(run.found.model, plant, other):.3f} "
            f"({error_percent(bound, plant, other):.3f}); {_told(run)}",
            flush=True,
        )


def bouc_wen(_: argparse.Namespace) -> None:
    """Print a Bouc-Wen hysteresis in front, with its own family and with plays."""
    front = hyst.BoucWen(1.0, 0.6, 0.5, 0.3)
    plant = stage(front, [(200.0, 0.03)], 1e-4, delay=3)
    other = multisine(1e-4, 1.0, 100.0, 10.0, 99)
    print("Bouc-Wen before 200 Hz, 10 kHz, 40 dB\n")
    for name, u in drives():
        if not name.startswith(("multisine to 1000", "linear", "levels", "triangle")):
            continue
        record = measured(plant, u, 40.0, 1)
        for family in ("bouc-wen", "pi"):
            run = identified(record, hysteresis=family)
            if run.found is None:
                print(f"{name:24s} {family:9s} {run.refused}", flush=True)
                continue
            print(
                f"{name:24s} {family:9s} own {error_percent(run.found.model, plant, u):7.3f}, "
                f"other {error_percent(run.found.model, plant, other):7.3f}; {_told(run)}",
                flush=True,
            )


def times(_: argparse.Namespace) -> None:
    """Print processor time and memory, beside a general least squares and FIR with ERA."""
    plant = stage(FRONT, [(200.0, 0.03)], 1e-4, delay=3)
    record = measured(plant, multisine(1e-4, 1.0, 1000.0, 10.0, 1000), 40.0, 1)
    run = identified(record)
    start = time.process_time()
    _peer(plant, record)
    peer = time.process_time() - start
    start = time.process_time()
    realize(fit_markov(_broad(plant, SAMPLES), 1000).values, 1e-4, order=2)
    paper = time.process_time() - start
    print(f"20,000 samples: {run.seconds:.1f} s (goal: 3)")
    print(f"  scipy.optimize.least_squares from one start of known structure: {peer:.1f} s")
    print(f"  FIR of 1000 taps and ERA, full band: {paper:.1f} s")
    print(f"  ratios {run.seconds / peer:.3g} and {run.seconds / paper:.3g}", flush=True)
    script = [sys.executable, "-m", "benchmarks", "hammerstein_drives", "--long", "1000000"]
    print(
        subprocess.run(script, capture_output=True, text=True, check=True).stdout.split("\n", 2)[2]
    )


def _broad(plant: Stage, samples: int) -> hyst.Record:
    return measured(plant, multisine(plant.dt, 1.0, 5000.0, 10.0, 1, samples), 40.0, 1)


def _long(samples: int) -> None:
    """Print time and peak memory of this process, which has done nothing else."""
    plant = stage(FRONT, [(200.0, 0.03)], 1e-4, delay=3)
    u = multisine(1e-4, 1.0, 1000.0, 10.0, 1000, samples)
    record = measured(plant, u, 40.0, 1)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    run = identified(record)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    start = time.process_time()
    fit_markov(_broad(plant, samples), 1000)
    paper = time.process_time() - start
    told = run.refused or _told(run)
    print(
        f"{samples} samples: {run.seconds:.1f} s (goal: 40), peak {peak:.0f} MB (goal: 1000), of "
        f"which {before:.0f} before; {told}\n  FIR of 1000 taps alone {paper:.1f} s, ratio "
        f"{run.seconds / paper:.3g}"
    )


def _peer(plant: Stage, record: hyst.Record) -> Array:
    """Fit five plays and two poles with numpy and scipy alone, from near the truth."""
    names = FRONT.p.size

    def output(theta: Array) -> Array:
        p0, p, r = theta[0], theta[1 : 1 + names], theta[1 + names : 1 + 2 * names]
        a1, a2, b1, offset = theta[1 + 2 * names :]
        z, v = np.zeros(names), np.empty(record.u.size)
        low, high = record.u[:, None] - r, record.u[:, None] + r
        for k in range(record.u.size):
            z = np.minimum(np.maximum(z, low[k]), high[k])
            v[k] = p @ z
        late = np.zeros(v.size)
        late[plant.delay :] = (v + p0 * record.u)[: v.size - plant.delay]
        b = [0.0, b1, 1.0 + a1 + a2 - b1]
        y = np.asarray(scipy.signal.lfilter(b, [1.0, a1, a2], late))
        return np.asarray(y + offset)

    truth = np.concatenate([[0.6], FRONT.p, FRONT.r, plant.a[1:], [plant.b[1], 0.0]])
    start = truth * np.where(np.arange(truth.size) < 1 + 2 * names, 1.05, 1.0)
    found = scipy.optimize.least_squares(
        lambda theta: (output(theta) - record.y)[2000:], start, x_scale=np.abs(truth) + 1e-3
    )
    return np.asarray(found.x)


def bad_input(_: argparse.Namespace) -> None:
    """Print what is said of records that do not determine it, or of no such system."""
    for name, record in _bad():
        run = identified(record)
        if run.found is None:
            print(f"{name}: refused, {run.seconds:.1f} s\n  {run.refused}", flush=True)
            continue
        print(f"{name}: {_told(run)}", flush=True)
        for sentence in (*run.found.verdict.sentences, *run.found.undetermined):
            print(f"  {sentence}")


def _bad() -> Iterator[tuple[str, hyst.Record]]:
    plant, k = stage(FRONT, [(200.0, 0.03)], 1e-4, delay=3), np.arange(SAMPLES)
    broad = multisine(1e-4, 1.0, 1000.0, 10.0, 7)
    for name, u in {
        "constant drive": np.full(SAMPLES, 5.0),
        "one step": np.where(k < 2000, 0.0, 10.0),
        "one sine of 3 Hz": 10.0 * np.sin(2.0 * np.pi * 3e-4 * k),
        "drive smaller than any play": 0.04 * broad,
        "multisine to 60 Hz": multisine(1e-4, 1.0, 60.0, 10.0, 7),
        "two levels, held 5": np.repeat(np.random.default_rng(1).choice([-10.0, 10.0], 4000), 5),
    }.items():
        yield name, measured(plant, u, 40.0, 1)
    for name, b, a in (
        ("pole at 0.99999", [1e-5], [1.0, -0.99999]),
        ("integrator", [1e-3], [1.0, -1.0]),
        ("unstable pole at 1.0005", [1e-3], [1.0, -1.0005]),
        ("zeros on the circle at 500 Hz", *_with_zeros()),
    ):
        yield name, measured(Stage(FRONT, np.array(b), np.array(a), 1e-4), broad, 40.0, 1)
    record = measured(plant, broad, 40.0, 1)
    for name, share in (("output clipped at 60 %", 0.6), ("output clipped at 90 %", 0.9)):
        most = share * np.abs(record.y).max()
        yield name, hyst.Record(record.u, np.clip(record.y, -most, most), record.dt)
    for share in (0.2, 0.5):
        y = with_feedback(broad, share, 1e-4)
        y = y + 0.01 * y.std() * np.random.default_rng(1).normal(size=y.size)
        yield f"hysteresis in a loop, {share:g}", hyst.Record(broad, y, 1e-4)
    yield "noise alone", hyst.Record(broad, np.random.default_rng(1).normal(size=SAMPLES), 1e-4)


def _with_zeros() -> tuple[Array, Array]:
    plant = stage(FRONT, [(200.0, 0.03)], 1e-4)
    zeros = np.array([1.0, -2.0 * np.cos(2.0 * np.pi * 0.05), 1.0])
    return np.convolve(zeros / zeros.sum(), [plant.a.sum()]), plant.a

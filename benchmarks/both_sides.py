"""Dynamics before a hysteresis and on both sides of it, fitted by `hyst.fit` from rough starts.

Plants of five plays at 10 kHz, 20,000 samples, 40 dB, driven by a random-phase multisine of 1 to
1000 Hz and by a sweep over the same band. Starts: frequencies 10 % off, plays of equal weight at
other radii. Printed, of some runs with other noise: the error of the output in percent of its
deviation (the noise is 1 %), the worst of them, how far the frequency is off, scatter of
frequencies and damping over their standard errors, seconds of a fit. Beside it what SciPy's
trust-region method makes of the same start with the same Jacobian, all constants free.
"""

from __future__ import annotations

import time

import numpy as np
from scipy.optimize import least_squares

import hyst
from benchmarks.timing import report
from hyst import Operator
from hyst.models import low_pass, resonance

DT, SAMPLES, RUNS = 1e-4, 20_000, 20
PLAYS = hyst.PrandtlIshlinskii([0.25, 0.2, 0.15, 0.1, 0.1], [0.05, 0.15, 0.3, 0.45, 0.6], p0=0.5)
ROUGH = hyst.PrandtlIshlinskii([0.2] * 5, [0.07, 0.2, 0.35, 0.5, 0.65], p0=0.6)

CASES: dict[str, tuple[Operator, Operator]] = {
    "plays @ 200 Hz/0.3": (
        PLAYS @ resonance(200.0, 0.3, DT),
        ROUGH @ resonance(220.0, 0.33, DT),
    ),
    "plays @ low-pass 300 Hz, order 2": (
        PLAYS @ low_pass(300.0, DT, 2),
        ROUGH @ low_pass(270.0, DT, 2),
    ),
    "200 Hz/0.03 @ plays @ low-pass 2 kHz": (
        resonance(200.0, 0.03, DT) @ PLAYS @ low_pass(2000.0, DT),
        resonance(220.0, 0.03, DT) @ ROUGH @ low_pass(1800.0, DT),
    ),
    "the same from 180 Hz/0.04": (
        resonance(200.0, 0.03, DT) @ PLAYS @ low_pass(2000.0, DT),
        resonance(180.0, 0.04, DT) @ ROUGH @ low_pass(2200.0, DT),
    ),
}


def main() -> None:
    print(
        f"{'plant':37s} {'drive':10s} {'error %':>8s} {'worst':>7s} {'off, Hz':>8s} "
        f"{'scatter/stated':>15s} {'s':>6s} {'SciPy: error %, s':>18s}"
    )
    for name, (true, start) in CASES.items():
        for kind, u in (("multisine", multisine()), ("sweep", sweep())):
            row = measured(true, start, u, f"{name}, {kind}")
            print(f"{name:37s} {kind:10s} {row}", flush=True)


def measured(true: Operator, start: Operator, u: np.ndarray, name: str) -> str:
    """Give a row: errors over runs with other noise."""
    y = true(u)
    deviation = float(np.std(y))
    errors, values, stated, seconds = [], [], [], []
    for seed in range(RUNS):
        record = noisy(u, y, seed)
        begun = time.perf_counter()
        found = hyst.fit(start, record, start=0, allow_unconverged=True)
        seconds.append(time.perf_counter() - begun)
        errors.append(100.0 * float(np.std(found.model(u) - y)) / deviation)
        modes = [i for i, each in enumerate(found.parameter_names) if _is_mode(each)]
        values.append(found.parameter_values[modes])
        stated.append(found.standard_errors[modes])
    names = [each for each in found.parameter_names if _is_mode(each)]
    at = next(i for i, each in enumerate(names) if "frequency" in each)
    off = float(np.abs(np.array(values)[:, at] - _frequency(true)).max())
    ratio = np.std(values, axis=0, ddof=1) / np.sqrt(np.mean(np.square(stated), axis=0))
    peer, peer_seconds = by_scipy(start, noisy(u, y, 0))
    peer_error = 100.0 * float(np.std(peer(u) - y)) / deviation
    report(f"SciPy's time over ours, {name}", peer_seconds / float(np.median(seconds)))
    report(f"error over noise, {name}", float(np.median(errors)), better="smaller")
    return (
        f"{np.median(errors):8.3f} {max(errors):7.3f} {off:8.4f} "
        f"{ratio.min():7.2f} to {ratio.max():4.2f} {np.median(seconds):6.2f} "
        f"{peer_error:11.3f} {peer_seconds:6.2f}"
    )


def by_scipy(start: Operator, record: hyst.Record) -> tuple[Operator, float]:
    """Fit all constants from the same start by SciPy, with hyst's own Jacobian."""
    own = start.parameters()
    begun = time.perf_counter()

    def residual(theta: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            try:
                y = start.with_parameters(start.nearest_parameters(theta))(record.u)
            except hyst.InputError:  # it overflows: not stable
                return np.full(record.u.size, 1e3)
        return np.clip(y - record.y, -1e3, 1e3)

    def jacobian(theta: np.ndarray) -> np.ndarray:
        return start.with_parameters(start.nearest_parameters(theta)).jacobian(record.u)

    found = least_squares(
        residual,
        own.values,
        jacobian,
        bounds=(own.lower, own.upper),
        x_scale="jac",
        max_nfev=200,
    )
    operator = start.with_parameters(start.nearest_parameters(found.x))
    return operator, time.perf_counter() - begun


def noisy(u: np.ndarray, y: np.ndarray, seed: int) -> hyst.Record:
    sigma = 0.01 * float(np.std(y))
    return hyst.Record(u, y + sigma * np.random.default_rng(seed).normal(size=u.size), DT)


def multisine() -> np.ndarray:
    lines = np.zeros(SAMPLES // 2 + 1, dtype=complex)
    last = int(1000.0 * SAMPLES * DT)
    lines[2 : last + 1] = np.exp(2j * np.pi * np.random.default_rng(0).random(last - 1))
    u = np.fft.irfft(lines, SAMPLES)
    return np.asarray(u / np.abs(u).max())


def sweep() -> np.ndarray:
    """Sweep from 1 to 1000 Hz, an octave in equal times."""
    t = np.arange(SAMPLES) / SAMPLES
    return np.asarray(np.sin(2.0 * np.pi * SAMPLES * DT / np.log(1e3) * (1e3**t - 1.0)))


def _is_mode(name: str) -> bool:
    return any(each in name for each in ("frequency", "damping", "time_constant"))


def _frequency(true: Operator) -> float:
    """Natural frequency of the first resonance of a plant, Hz."""
    found = [
        abs(np.log(each.poles()[0])) / (2.0 * np.pi * DT)
        for each in true.parts  # type: ignore[attr-defined]
        if isinstance(each, hyst.LinearDynamics) and each.order == 2
    ]
    return float(found[0])

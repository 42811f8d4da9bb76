"""Hysteresis with dynamics: times, and errors over the Cramer-Rao bound in a hundred runs."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable

import numpy as np
import scipy.signal

import hyst
from benchmarks.timing import interleaved, report_times
from hyst.identification.families.hammerstein import fit_markov
from hyst.models import LinearDynamics, StableInverse
from hyst.signals import Record, multisine
from hyst.studies import s0_hammerstein as s0

RUNS = 100
DT = 1e-3
W = 2.0 * np.pi * 80.0
G = LinearDynamics.from_continuous([1.0], [W**-2, 0.3 / W, 1.0], DT)
PI = hyst.PrandtlIshlinskii([0.3, 0.2, 0.15], [0.5, 1.5, 3.0], 1.0)
U = multisine(DT, 6000, amplitude=10.0).u


def main() -> None:
    filters()
    steps()
    cramer_rao()
    nonminimum_phase()


def filters() -> None:
    print("record of 100,000 samples: state space against scipy.signal.lfilter (goal: at most 3)")
    u = np.random.default_rng(0).normal(size=100_000)
    for order in (1, 2, 3, 4, 6, 8, 12):
        b, a = scipy.signal.butter(order, 0.2)
        dynamics = LinearDynamics.from_transfer_function(b, a, DT)
        works = {
            "hyst": functools.partial(dynamics, u),
            "lfilter": functools.partial(scipy.signal.lfilter, b, a, u),
        }
        times = interleaved(works)
        name = f"state space over lfilter, order {order}"
        over = report_times(name, times, "hyst", "lfilter", better="smaller")
        print(f"  order {order:2d}: {over:.2f}")


def steps() -> None:
    record = s0.simulate(s0.TWO_SIDED, s0.designed_input(), 0.01)[1]
    print("\npaper's example, 100,000 samples, mu = 30, designed input")
    print(f"  step 1: {1e3 * _seconds(lambda: fit_markov(record, 30)):.1f} ms (goal: 60)")
    for noise in (0.0, 0.01):
        noisy = s0.simulate(s0.TWO_SIDED, s0.designed_input(), noise)[1]
        start = time.process_time()
        found = s0.refined(noisy)
        spent = time.process_time() - start
        error = s0.markov_error(found.dynamics.impulse_response(31))
        print(f"  all steps, noise {noise:g}: {spent:.1f} s (goal: 3), Markov error {error:.2g} %")


def cramer_rao() -> None:
    clean = (G @ PI)(U)
    noise = 0.01 * clean.std()
    bound = _bound(noise)
    errors, outside = [], 0
    for seed in range(RUNS):
        y = clean + noise * np.random.default_rng(seed).normal(size=U.size)
        found = hyst.identify(
            Record(U, y, DT),
            family="hammerstein",
            hysteresis="pi",
            plays=3,
            state_order=2,
            fir_order=64,
            delay=0,
            start=64,  # the actuator is known to start at rest
        )
        errors.append(_theta_of(found) - _truth())
        order = np.lexsort((found.poles.imag, found.poles.real))
        off = found.poles[order] - np.sort_complex(G.poles())
        spread = found.pole_standard_errors[order]
        inside = (np.abs(off.real) <= 3.0 * spread.real) & (np.abs(off.imag) <= 3.0 * spread.imag)
        outside += not inside.all()
    ratios = np.sqrt(np.mean(np.square(errors), axis=0)) / bound
    names = ("p0", "p1", "p2", "p3", "r1", "r2", "r3", "offset", "a1", "a2", "b1")
    print(f"\n40 dB noise, {RUNS} runs: rms error over the Cramer-Rao bound (goal: at most 1.3)")
    print("  " + "  ".join(f"{name} {each:.2f}" for name, each in zip(names, ratios, strict=True)))
    print(f"  poles within 3 standard errors in {RUNS - outside} of {RUNS} runs (goal: 95)")


def nonminimum_phase() -> None:
    mixed = LinearDynamics.from_zeros_poles_gain([1.6], [0.5, 0.3], 1.0, DT)
    inverse = StableInverse.of(mixed)
    v = PI(U)
    error = np.abs(inverse(mixed(v)) - v)[inverse.valid(v.size)].max() / np.ptp(v)
    print(f"\nzero at 1.6: error of v {error:.1e} of its range (goal: 1e-6)")


def _truth() -> np.ndarray:
    a = np.poly(G.poles()).real
    return np.array([1.0, 0.3, 0.2, 0.15, 0.5, 1.5, 3.0, 0.0, a[1], a[2], G.impulse_response(2)[1]])


def _theta_of(found: hyst.Identified) -> np.ndarray:
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    plays = ("p0", "p[1]", "p[2]", "p[3]", "r[1]", "r[2]", "r[3]")
    names = [f"prandtl_ishlinskii.{each}" for each in plays]
    names += ["affine.offset", "dynamics.a[1]", "dynamics.a[2]", "dynamics.b[1]"]
    return np.array([values[name] for name in names])


def _simulated(theta: np.ndarray) -> np.ndarray:
    """The output for DC gain 1, in the parameters of the bound; filtered by scipy."""
    p0, p1, p2, p3, r1, r2, r3, offset, a1, a2, b1 = theta
    v = hyst.PrandtlIshlinskii([p1, p2, p3], [r1, r2, r3], p0)(U) + offset
    return scipy.signal.lfilter([0.0, b1, 1.0 + a1 + a2 - b1], [1.0, a1, a2], v)


def _bound(noise: float) -> np.ndarray:
    theta, columns = _truth(), []
    for i in range(theta.size):
        step = np.zeros(theta.size)
        step[i] = 1e-6
        columns.append((_simulated(theta + step) - _simulated(theta - step)) / 2e-6)
    jacobian = np.array(columns).T[64:]  # the identification leaves out as many samples
    return noise * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))


def _seconds(work: Callable[[], object]) -> float:
    spent = []
    for _ in range(5):
        start = time.process_time()
        work()
        spent.append(time.process_time() - start)
    return min(spent)

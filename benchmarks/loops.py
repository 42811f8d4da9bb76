"""Loops behind the dynamics: how often noise alone is called a difference, and what is found.

Stages are simulated: three plays, then dynamics with a zero outside the circle and a delay (1 kHz),
or a resonance of 200 Hz with three samples of delay, whose inverse is limited to a band (10 kHz).
Sines at three frequencies, noise of 0.6 % of the range of v on the output, white or of first order
(0.9, 0.995 from sample to sample), which no part of the test is told. The first table counts
p-values below a level and loops called different (level 0.05, tolerance 0.5 % of range) where the
model is right; the second what is found, at the default level of 0.01, where it is wrong.

``python -m benchmarks loops [--runs N]``
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import signal

import hyst
from hyst.compensation import LoopsBehind, loops_behind
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

RUNS = 200
NOISE = 0.05
RADII = [0.5, 1.5, 3.0]
WEIGHTS = [0.2, 0.15, 0.1]
FRONT = hyst.PrandtlIshlinskii(WEIGHTS, RADII, p0=0.6)


def slow_stage(late: int = 2, pole: complex = 0.3 + 0.4j) -> LinearDynamics:
    """Give dynamics at 1 kHz, gain 1 at rest."""
    G = LinearDynamics.from_zeros_poles_gain([1.6], [0.5, pole, np.conj(pole)], 1.0, 1e-3)
    G = G.in_units(1.0, 1.0 / G.dc_gain())
    return LinearDynamics(G.A, G.B, G.C, G.D, G.dt, late)


def resonance(late: int = 3, frequency: float = 200.0) -> LinearDynamics:
    """Give a resonance of damping 0.03 at 10 kHz."""
    w = 2.0 * np.pi * frequency
    G = LinearDynamics.from_continuous([w**2], [1.0, 0.06 * w, w**2], 1e-4)
    return LinearDynamics(G.A, G.B, G.C, G.D, G.dt, late)


def recorded(
    actuator: hyst.Operator,
    dt: float,
    frequencies: Sequence[float],
    periods: float,
    seed: int,
    colour: float = 0.0,
) -> list[hyst.Record]:
    """Give records of sines of amplitude 5."""
    rng = np.random.default_rng(seed)
    records = []
    for frequency in frequencies:
        k = np.arange(int(periods / frequency / dt) + 60)
        u = 5.0 * np.sin(2.0 * np.pi * frequency * dt * k)
        white = NOISE * np.sqrt(1.0 - colour**2) * rng.normal(size=u.size + 2000)
        noise = signal.lfilter([1.0], [1.0, -colour], white)[2000:]
        records.append(hyst.Record(u, actuator(u) + noise, dt))
    return records


def main() -> None:
    """Print both tables."""
    runs = int(sys.argv[sys.argv.index("--runs") + 1]) if "--runs" in sys.argv else RUNS
    print("stage   periods  colour   p < 0.05   p < 0.01   called different")
    G = slow_stage()
    for periods in (3.0, 6.0, 40.0):
        for colour in (0.0, 0.9, 0.995):
            found = _right(G, (4.0, 10.0, 23.7), periods, colour, runs)
            _print_levels(f"{'1 kHz':7s} {periods:7g} {colour:7g}", found)
    few = max(runs // 4, 1)
    _print_levels(
        "10 kHz       12       0", _right(resonance(), (20.0, 47.0, 90.0), 12.0, 0.0, few)
    )
    print("\nwrong in the model (range of v 9.2)             found, of", few)
    for name, true, model, dt, frequencies in _wrong():
        causes: Counter[str] = Counter()
        distance = 0.0
        for seed in range(few):
            (test,) = loops_behind(model, recorded(true, dt, frequencies, 12.0, seed)).tests
            causes[test.cause] += 1
            distance = test.distance_percent
        told = ", ".join(f"{cause} {count}" for cause, count in causes.most_common())
        print(f"{name:38s} {distance:5.2f} %    {told}")


def _right(
    G: LinearDynamics, frequencies: Sequence[float], periods: float, colour: float, runs: int
) -> list[LoopsBehind]:
    """See loops of a right model."""
    model = G @ FRONT
    return [
        loops_behind(model, recorded(model, G.dt, frequencies, periods, seed, colour), level=0.05)
        for seed in range(runs)
    ]


def _print_levels(name: str, found: Sequence[LoopsBehind]) -> None:
    values = np.array([1.0 if each.p_value is None else each.p_value for each in found])
    different = np.mean([not each.coincide for each in found])
    shares = np.mean(values < 0.05), np.mean(values < 0.01), different
    print(name, "".join(f"{100.0 * share:8.1f} % " for share in shares), flush=True)


def _wrong() -> list[tuple[str, hyst.Operator, hyst.Operator, float, tuple[float, ...]]]:
    G, R = slow_stage(), resonance()
    slow, fast = (2.0, 6.0, 15.0), (20.0, 47.0, 90.0)
    widening = hyst.RateDependentPrandtlIshlinskii(WEIGHTS, RADII, 5e-4, 1e-3, p0=0.6)
    wider = hyst.RateDependentPrandtlIshlinskii(WEIGHTS, RADII, 2e-3, 1e-3, p0=0.6)
    creep = hyst.Creep([0.06, 0.05], [0.02, 0.1], 1e-3)
    lag = hyst.Lag(2e-3, 1e-3)
    return [
        ("plays widen by 0.5 ms of rate", G @ widening, G @ FRONT, 1e-3, slow),
        ("plays widen by 2 ms of rate", G @ wider, G @ FRONT, 1e-3, slow),
        ("creep of 11 %", G @ creep @ FRONT, G @ FRONT, 1e-3, slow),
        ("lag of 2 ms", G @ lag @ FRONT, G @ FRONT, 1e-3, slow),
        ("a sample of delay", slow_stage(3) @ FRONT, G @ FRONT, 1e-3, slow),
        ("0.4 samples of delay", G @ hyst.Delay(0.4, 1e-3) @ FRONT, G @ FRONT, 1e-3, slow),
        ("resonance 190 for 200 Hz", resonance(3, 190.0) @ FRONT, R @ FRONT, 1e-4, fast),
        ("a sample of delay at 10 kHz", resonance(4) @ FRONT, R @ FRONT, 1e-4, fast),
    ]

"""The yardstick of hysteresis with dynamics: its ratio for plants of its class and of none."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import numpy as np
import scipy.linalg
import scipy.signal
from numpy.typing import NDArray

import hyst
from benchmarks.resonant_records import balanced, with_feedback
from hyst.identification.families.hammerstein.joint import joint
from hyst.identification.families.hammerstein.yardstick.yardstick import (
    Stretch,
    Yardstick,
    yardstick,
)
from hyst.identification.families.hammerstein.yardstick.yardstick_told import level_of
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.problem import problem_of
from hyst.identification.fit_model import parametrize_own
from hyst.identification.record_use.used_samples import prepare
from hyst.models import LinearDynamics
from hyst.operators import Operator
from hyst.signals import Record, multisine

Array = NDArray[np.float64]
Plant = tuple[str, Callable[[Array], Array], Operator, LinearDynamics]

DT, SAMPLES, START, NOISE = 1e-4, 20_000, 2000, 0.01
FRONT = hyst.PrandtlIshlinskii([0.3, 0.25, 0.2, 0.15, 0.1], [0.5, 1.5, 3.0, 5.0, 8.0], 0.6)
GUESS = hyst.PrandtlIshlinskii(np.full(5, 0.12), 10.0 * np.geomspace(0.05, 0.8, 5), 0.8)
BOUC_WEN = hyst.BoucWen(1.0, 0.6, 0.5, 0.3)


def main() -> None:
    print("ratio (verdict; what is missing), noise 1 % of the output, 20,000 samples at 10 kHz;")
    print("hysteresis and dynamics fitted jointly from the plant's own or five even plays\n")
    drives = dict(_drives())
    print(f"{'plant':36s}" + "".join(f"{name:>26s}" for name in drives))
    spent = []
    for name, plant, front, dynamics in _plants():
        cells = []
        for u in drives.values():
            y = plant(u)
            y = y + NOISE * y.std() * np.random.default_rng(1).normal(size=y.size)
            found, seconds = _fitted(u, y, front, dynamics)
            spent.append(seconds)
            cells.append(f"{found.ratio:.3g} ({level_of(found)}; {found.missing})")
        print(f"{name:36s}" + "".join(f"{cell:>26s}" for cell in cells), flush=True)
    print(f"\nseconds of one yardstick: median {np.median(spent):.2f}, most {max(spent):.2f}")


def _drives() -> Iterator[tuple[str, Array]]:
    t, rng = np.arange(SAMPLES) * DT, np.random.default_rng(0)
    yield "full band, two periods", multisine(DT, SAMPLES // 2, amplitude=10.0, periods=2).u
    yield "1 to 1000 Hz, one period", multisine(DT, SAMPLES, amplitude=10.0, band=(1, 1000)).u
    yield "levels held 5 samples", np.repeat(rng.uniform(-10.0, 10.0, SAMPLES // 5), 5)
    yield "chirp 1 to 1000 Hz", 10.0 * scipy.signal.chirp(t, 1.0, t[-1], 1000.0)
    yield "triangle 10 Hz", 10.0 * scipy.signal.sawtooth(20.0 * np.pi * t + 1.0, 0.5)


def _plants() -> Iterator[Plant]:
    one, two = _modes((200.0, 0.03)), _modes((200.0, 0.03), (520.0, 0.03))
    three = _modes((60.0, 0.05), (150.0, 0.03), (320.0, 0.03))
    soft = _modes((200.0, 0.1))
    yield "five plays, 200 Hz", one @ FRONT, FRONT, one
    yield "five plays, 200 + 520 Hz", two @ FRONT, FRONT, two
    yield "200 + 520 Hz with two states", two @ FRONT, FRONT, one
    yield "60 + 150 + 320 Hz with two states", three @ FRONT, FRONT, _modes((60.0, 0.05))
    yield "Bouc-Wen as Bouc-Wen", one @ BOUC_WEN, BOUC_WEN, one
    yield "Bouc-Wen as five plays", one @ BOUC_WEN, GUESS, one
    yield "Dahl as five plays", one @ hyst.Dahl(1.5, 1.0), GUESS, one
    yield "feedback of sliding elements, 0.5", lambda u: with_feedback(u, 0.5, DT), GUESS, soft
    yield "feedback of sliding elements, 0.2", lambda u: with_feedback(u, 0.2, DT), GUESS, soft
    yield "dynamics before hysteresis", FRONT @ one, GUESS, one


def _modes(*pairs: tuple[float, float]) -> LinearDynamics:
    b = a = np.ones(1)
    for frequency, damping in pairs:
        w = 2.0 * np.pi * frequency
        continuous = ([w * w], [1.0, 2.0 * damping * w, w * w])
        numerator, denominator, _ = scipy.signal.cont2discrete(continuous, DT)
        b, a = np.convolve(b, numerator.ravel()), np.convolve(a, denominator)
    return balanced(LinearDynamics.from_transfer_function(b, a, DT, 3))


def _fitted(
    u: Array, y: Array, front: Operator, dynamics: LinearDynamics
) -> tuple[Yardstick, float]:
    data = prepare(Record(u, y, DT), START)
    parametrization, theta = joint(parametrize_own(front, None, {}), dynamics)
    theta = minimize(problem_of(data, parametrization), theta, 100, 2e-2).theta
    modelled = np.asarray(parametrization.operator(theta)(u))
    start = time.process_time()
    found = yardstick([Stretch(u, y, modelled, START)], parametrization.dynamics(theta))
    return found, time.process_time() - start

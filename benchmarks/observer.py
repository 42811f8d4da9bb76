"""Design of disturbance observers: norms and times on the paper's example and on random plants.

    python -m benchmarks observer

Prints, for one machine and one run,
- the exact norms of the paper's two examples and the times of SLPMM alone and of a design,
- norm, noise gain and fastest pole of three stages: of the least norm, of the quietest gain that is
  as good, with a row of noise, with more order, and the bound of any order at that noise,
- on 50 random stable plants of order 2 to 6, with weights and internal models at random: how often
  the design is worse than SLPMM alone, how often a dense grid of frequencies contradicts a
  certified norm, the share within 2 % of the best of 100 descents from random starts, all of gains
  of least norm, and how much quieter those are that a design takes.

HYST_OBSERVER_CASES and HYST_OBSERVER_STARTS shorten it.
"""

from __future__ import annotations

import os
import time

import numpy as np
from numpy.typing import NDArray

from hyst.control import InternalModel, design_disturbance_observer
from hyst.control.disturbance_observer.certificate import weighted_loop
from hyst.control.disturbance_observer.descent import descend, random_parameters
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.stacked_gain import StackedGain, feedback_matrix
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import HystError

Array = NDArray[np.float64]

OMEGA = 2.0 * np.pi * 90.0
PLANT = ([OMEGA**2], [1.0, 1.6 * OMEGA, OMEGA**2])
WU = ([-1.0, -960.0, 0.0], [1.0, 960.0, 2400.0**2])
WP = ([0.5, 64.0 * np.pi], [1.0, 0.2])

_W = 2.0 * np.pi * 500.0
STAGES = {
    "repaired example": (PLANT, ([4.0, 8.0], [1.0, 0.0]), WU, WP),
    "stage of 200 Hz": (
        ([1579136.7], [1.0, 75.398, 1579136.7]),
        ([20.0], [1.0, 0.0]),
        ([3.9789e-4, 0.02], [3.9789e-5, 1.0]),
        ([0.5, 94.25], [1.0, 0.1]),
    ),
    "stage of 500 Hz": (
        ([_W**2], [1.0, 0.1 * _W, _W**2]),
        ([0.02, 150.0], [1.0, 0.0]),
        ([2.0, 0.0], [1.0, 31416.0]),
        ([0.5, 188.0], [1.0, 0.1]),
    ),
}


def random_polynomial(rng: np.random.Generator, degree: int) -> Array:
    """Stable, with roots between 10 and 3000 rad/s, damped 5 % at least."""
    factors = []
    for _ in range(degree // 2):
        omega, zeta = 10.0 ** rng.uniform(1.0, 3.5), rng.uniform(0.05, 1.2)
        factors.append([1.0, 2.0 * zeta * omega, omega**2])
    if degree % 2:
        factors.append([1.0, 10.0 ** rng.uniform(1.0, 3.5)])
    product = np.array([1.0])
    for factor in factors:
        product = np.polymul(product, factor)
    return np.asarray(product)


def random_problem(rng: np.random.Generator) -> ObserverProblem:
    """A stable plant without zeros on the right, a PI controller that suits it, and weights."""
    order = int(rng.integers(2, 7))
    num, den = random_polynomial(rng, int(rng.integers(0, order))), random_polynomial(rng, order)
    num = num * den[-1] / num[-1]
    plant = as_linear_system((num, den))
    # The states of a design: the output is the first of them.
    plant = LinearSystem(plant.A.T, plant.C.T, plant.B.T, plant.D)
    slow = np.abs(plant.poles()).min()
    kp, ki = 10.0 ** rng.uniform(-1.0, 1.0), 10.0 ** rng.uniform(-2.0, 0.5) * slow
    while True:
        controller = as_linear_system(([kp, ki], [1.0, 0.0]))
        poles = np.linalg.eigvals(feedback_matrix(plant, controller))
        if (poles.real < -0.02 * np.abs(poles)).all():
            break
        kp, ki = 0.7 * kp, 0.6 * ki
    corner = 10.0 ** rng.uniform(0.0, 1.5) * slow
    if rng.random() < 0.5:
        zeta = rng.uniform(0.05, 0.7)
        Wu = ([1.0, 2.0 * zeta * corner, 0.0], [1.0, 2.0 * zeta * corner, corner**2])
    else:
        high = rng.uniform(0.5, 3.0)
        Wu = ([high, high * 0.1 * corner], [1.0, corner])
    band, floor = 10.0 ** rng.uniform(-1.5, 0.3) * slow, rng.uniform(0.2, 0.7)
    Wp = ([floor, floor * band], [1.0, 10.0 ** rng.uniform(-4.0, -2.0) * band])
    model = InternalModel.integrator()
    kind = rng.random()
    if kind < 0.25:
        model = InternalModel.ramp()
    elif kind < 0.5:
        model = model + InternalModel.sinusoid(rng.uniform(0.2, 2.0) * band)
    return ObserverProblem(plant, controller, as_linear_system(Wu), as_linear_system(Wp), model)


def dense_grid_norm(problem: ObserverProblem, gain: Array) -> float:
    """The largest stacked gain on 20,000 frequencies, more around each pole of the loop."""
    system = weighted_loop(problem, gain)
    poles = system.poles()
    size = np.abs(poles)[np.abs(poles) > 0.0]
    w = np.geomspace(1e-3 * size.min(), 1e3 * size.max(), 20_000)
    near = np.abs(poles.imag)[:, None] + np.abs(poles.real)[:, None] * np.linspace(-4.0, 4.0, 81)
    w = np.concatenate([w, near[near > 0.0], size])
    value = 0.0
    for part in np.array_split(w, 20):
        value = max(value, float(np.linalg.norm(system.response(1j * part), axis=(1, 2)).max()))
    return value


def of(problem: ObserverProblem, **options: object) -> object:
    p = problem
    return design_disturbance_observer(
        p.plant, p.controller, p.Wu, p.Wp, p.internal_model, **options
    )


def best_of_random(problem: ObserverProblem, starts: int) -> float:
    gain = StackedGain(problem)
    return min(descend(gain, each).norm for each in random_parameters(gain, starts, 12345))


def paper() -> None:
    print("C          method           norm   seconds of processor")
    for kp in (8.0, 4.0):
        for method in ("slpmm", "slpmm+descent"):
            begin = time.process_time()
            found = design_disturbance_observer(
                PLANT, ([kp, 12.0 - kp], [1.0, 0.0]), WU, WP, method=method
            )
            seconds = time.process_time() - begin
            print(f"{kp:g} + {12 - kp:g}/s    {method:14s} {found.gamma:7.4f} {seconds:7.2f}")


def noise_and_order() -> None:
    print("stage             options         order   norm  sup Q/Pn  fastest 1/s  at that noise  s")
    for name, stage in STAGES.items():
        for options in (
            {"flat": 0.0},
            {},
            {"noise": 1.0},
            {"fastest_pole": np.pi * 1e4},
            {"order": "auto"},
            {"order": 6},
        ):
            begin = time.process_time()
            found = design_disturbance_observer(*stage, **options)
            seconds = time.process_time() - begin
            c, told = found.certificate, ", ".join(f"{k} {v}" for k, v in options.items())
            print(
                f"{name:17s} {told[:15]:15s} {found.problem.order:5d} {c.stacked_norm:7.4f} "
                f"{c.observer_noise_gain:9.3f} {c.fastest_pole:11.4g} "
                f"{found.lower_bound_at_noise:11.4f} {seconds:7.2f}"
            )


def random_plants(cases: int, starts: int) -> None:
    rng = np.random.default_rng(8)
    worse = contradicted = close = failed = 0
    seconds, quieter, given_up = [], [], []
    for case in range(cases):
        problem = random_problem(rng)
        begin = time.process_time()
        quiet = of(problem)
        seconds.append(time.process_time() - begin)
        found = of(problem, flat=0.0)
        loud = found.certificate.observer_noise_gain
        quieter.append(loud / quiet.certificate.observer_noise_gain)
        given_up.append(quiet.gamma / found.gamma - 1.0)
        try:
            alone = of(problem, method="slpmm").gamma
        except HystError as reason:
            alone, failed = np.inf, failed + 1
            print(f"     SLPMM: {reason}")
        on_grid = dense_grid_norm(problem, found.gain)
        best = best_of_random(problem, starts)
        worse += found.gamma > alone * (1.0 + 1e-9)
        contradicted += on_grid > found.gamma * (1.0 + 1e-7)
        close += found.gamma <= 1.02 * best
        print(
            f"{case:4d} order {problem.plant.order}+{problem.internal_model.order}  design "
            f"{found.gamma:8.4f}  slpmm {alone:8.4f}  grid {on_grid:8.4f}  best of {starts} "
            f"{best:8.4f}  bound {found.lower_bound:7.4f}  {seconds[-1]:5.2f} s",
            flush=True,
        )
    print(
        f"worse than SLPMM {worse}, SLPMM failed {failed}, contradicted {contradicted}, within 2 % "
        f"of the best of {starts} random starts {close} of {cases}; median {np.median(seconds):.2f}"
        f" s of processor a design, at most {max(seconds):.2f}"
    )
    print(
        f"noise gain lower {np.median(quieter):.3g} times in the median and {max(quieter):.3g} at "
        f"most, for at most {max(given_up):.2%} of the norm"
    )


def main() -> None:
    paper()
    noise_and_order()
    cases = int(os.environ.get("HYST_OBSERVER_CASES", "50"))
    random_plants(cases, int(os.environ.get("HYST_OBSERVER_STARTS", "100")))

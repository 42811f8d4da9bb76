"""The paper's example, and random plants, for tests of the disturbance observer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control import InternalModel, ObserverProblem, observer_problem
from hyst.errors import InputError

Array = NDArray[np.float64]

OMEGA, OMEGA_2 = 2.0 * np.pi * 90.0, 2400.0
PLANT = ([OMEGA**2], [1.0, 1.6 * OMEGA, OMEGA**2])
SECOND_MODE = [1.0, 0.4 * OMEGA_2, OMEGA_2**2]
TWO_MODES = ([OMEGA**2 * OMEGA_2**2], list(np.polymul(PLANT[1], SECOND_MODE)))  # eq. 41
WU = ([-1.0, -0.4 * OMEGA_2, 0.0], SECOND_MODE)  # eq. 44
WP = ([0.5, 0.5 * 2.0 * np.pi * 64.0], [1.0, 0.2])  # eq. 43
PRINTED_GAIN = [-117.381, 0.197, 17113.1]
PRINTED_C, REPAIRED_C = ([8.0, 4.0], [1.0, 0.0]), ([4.0, 8.0], [1.0, 0.0])


def random_problem(seed: int) -> ObserverProblem:
    """A stable plant of order 2 to 6 over 1.5 decades, a PI controller and weights that suit it."""
    rng = np.random.default_rng(seed)

    def polynomial(degree: int) -> Array:
        product = np.array([1.0])
        for _ in range(degree // 2):
            omega, zeta = 10.0 ** rng.uniform(1.5, 3.0), rng.uniform(0.1, 1.2)
            product = np.polymul(product, [1.0, 2.0 * zeta * omega, omega**2])
        if degree % 2:
            product = np.polymul(product, [1.0, 10.0 ** rng.uniform(1.5, 3.0)])
        return product

    order = int(rng.integers(2, 7))
    num, den = polynomial(int(rng.integers(0, order))), polynomial(order)
    num = num * den[-1] / num[-1]
    slow = float(np.abs(np.roots(den)).min())
    corner, floor = 10.0 ** rng.uniform(0.0, 1.5) * slow, rng.uniform(0.2, 0.7)
    high, band = rng.uniform(0.5, 3.0), 10.0 ** rng.uniform(-1.5, 0.0) * slow
    Wu = ([high, 0.1 * high * corner], [1.0, corner])
    Wp = ([floor, floor * band], [1.0, 10.0 ** rng.uniform(-3.0, -2.0) * band])
    models: list[Callable[[], InternalModel]] = [
        InternalModel.integrator,
        InternalModel.ramp,
        lambda: InternalModel.integrator() + InternalModel.sinusoid(band),
    ]
    model = models[int(rng.integers(0, 3))]()
    kp, ki = rng.uniform(0.1, 2.0), rng.uniform(0.05, 1.0) * slow
    while True:
        try:
            return observer_problem((num, den), ([kp, ki], [1.0, 0.0]), Wu, Wp, model)
        except InputError:
            kp, ki = 0.5 * kp, 0.5 * ki


def design_arguments(problem: ObserverProblem) -> tuple[Any, ...]:
    p = problem
    return p.plant, p.controller, p.Wu, p.Wp, p.internal_model

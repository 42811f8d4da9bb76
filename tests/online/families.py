"""Actuators of families that adapt, their starts, and the Cramer-Rao bound by differences."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.online import ModelEstimator
from hyst.operators import Operator

Array = NDArray[np.float64]

DT = 1e-3


def plays(rng: np.random.Generator) -> hyst.PrandtlIshlinskii:
    r = np.cumsum(rng.uniform(0.35, 0.7, 2))
    return hyst.PrandtlIshlinskii(rng.uniform(0.3, 0.8, 2), r, rng.uniform(0.6, 1.4))


def bend(rng: np.random.Generator) -> hyst.DeadZone:
    knots = [0.0, rng.uniform(1.0, 2.0), -rng.uniform(1.0, 2.0)]
    return hyst.DeadZone([1.0, rng.uniform(0.2, 0.6), rng.uniform(-0.5, -0.2)], knots)


def rate_dependent(rng: np.random.Generator) -> Operator:
    rest, beta = plays(rng), rng.uniform(0.003, 0.008)
    return hyst.RateDependentPrandtlIshlinskii(rest.p, rest.r, beta, DT, rest.p0)


FAMILIES: dict[str, Callable[[np.random.Generator], Operator]] = {
    "pi": plays,
    "rdpi": rate_dependent,
    "ramberg-osgood": lambda rng: hyst.RambergOsgood(
        *rng.uniform([0.5, 0.3, 0.8], [1.5, 1.0, 1.6])
    ),
    "mpi": lambda rng: hyst.ModifiedPrandtlIshlinskii(plays(rng), bend(rng)),
    "gpi": lambda rng: hyst.GeneralizedPrandtlIshlinskii(bend(rng), plays(rng)),
    "creep": lambda rng: (
        hyst.Creep([rng.uniform(0.15, 0.3)], [rng.uniform(0.05, 0.2)], DT) @ plays(rng)
    ),
}


def two_sines(samples: int, phase: float = 1.0) -> Array:
    t = np.arange(samples) * DT
    return 3.2 * np.sin(4.0 * np.pi * t) + np.sin(2.0 * np.pi * 7.3 * t + phase)


def free_of(truth: Operator) -> NDArray[np.intp]:
    """Give places of the constants that are estimated."""
    held = ModelEstimator(truth, dt=DT).held
    return np.array([i for i, name in enumerate(truth.parameters().names) if name not in held])


def start_off(truth: Operator, rng: np.random.Generator) -> Operator:
    """Give a start with every free constant 20 to 40 % off that can be inverted."""
    free = free_of(truth)
    while True:
        theta = truth.parameters().values.copy()
        theta[free] *= 1.0 + rng.choice([-1.0, 1.0], free.size) * rng.uniform(0.2, 0.4, free.size)
        start = truth.with_parameters(truth.nearest_parameters(theta))
        try:
            ModelEstimator(start, dt=DT)
        except hyst.errors.NotInvertibleError:
            continue
        return start


def bound_of(truth: Operator, u: Array, noise: float) -> Array:
    """Give the bound of the free constants, by central differences of the output."""
    theta, columns = truth.parameters().values, []
    for place in free_of(truth).tolist():
        step = np.zeros_like(theta)
        step[place] = 1e-6 * abs(theta[place])
        ends = [truth.with_parameters(theta + sign * step)(u) for sign in (1.0, -1.0)]
        columns.append((ends[0] - ends[1]) / (2.0 * step[place]))
    jacobian = np.stack(columns, axis=1)
    return np.asarray(noise * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian))))


def learn(estimator: ModelEstimator, u: Array, y: Array) -> None:
    for u_k, y_k in zip(u.tolist(), y.tolist(), strict=True):
        estimator.update(u_k, y_k)

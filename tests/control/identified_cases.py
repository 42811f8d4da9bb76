"""Stages with hysteresis in front of dynamics, and quick fits of their records."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.control import IdentifiedPlant, identified_plant
from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import joint
from hyst.identification.families.hammerstein.told.kept_errors import kept_errors
from hyst.identification.families.hammerstein.told.known_dynamics import known_dynamics
from hyst.identification.families.hammerstein.told.slope_error import slope_error_of
from hyst.identification.families.hammerstein.yardstick.yardstick import stretches_of
from hyst.identification.fit.bounded_least_squares import Solution
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.used_samples import prepare
from hyst.identification.result.fit_spread import spread_of_fit
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

DT = 5e-4
W = 2.0 * np.pi * 120.0
G = LinearDynamics.from_continuous([W * W], [1.0, 0.1 * W, W * W], DT, delay=2)
PI = hyst.PrandtlIshlinskii([0.3, 0.2], [1.0, 3.0], 0.8)


def drive(samples: int = 3000, band: tuple[float, float] | None = None) -> Array:
    return hyst.signals.multisine(DT, samples, amplitude=10.0, band=band).u


def record(seed: int, u: Array, noise: float = 0.02, dynamics: LinearDynamics = G) -> hyst.Record:
    y = (dynamics @ PI)(u)
    rng = np.random.default_rng(seed)
    return hyst.Record(u, y + noise * y.std() * rng.normal(size=y.size), DT)


@cache
def found(seed: int = 0, band: tuple[float, float] | None = None) -> hyst.Identified:
    """What identify makes of a record: a second."""
    measured = record(seed, drive(band=band))
    options = {"hysteresis": "pi", "plays": 2, "state_order": 2}
    return hyst.identify(measured, family="hammerstein", **options)


def fitted_from_truth(measured: hyst.Record, start: LinearDynamics = G) -> IdentifiedPlant:
    """Only the last fit of identify, from the true constants: a tenth of the time."""
    data = prepare((measured,), "auto")
    values = PI.parameters().values
    free = np.full(values.size, np.inf)
    front = Parametrization(PI, np.eye(values.size), np.zeros(values.size), -free, free)
    parametrization, theta = joint((front, values), start)
    family = hyst.families.Hammerstein(hysteresis=hyst.families.PrandtlIshlinskii())
    fit = Fit(family, 1, parametrization, Solution(theta, np.inf, 0, ""))
    fit = replace(fit, solution=family.solve(fit.problem(data), theta, 60))
    spread = spread_of_fit(data, fit)
    known = known_dynamics(fit, data, spread)
    slope_error = slope_error_of(fit, data, spread)
    errors = kept_errors(known, stretches_of(fit, data), slope_error)
    about = hyst.ModelDescription(dt=DT, dynamics_errors=errors)
    return identified_plant(fit.operator.with_description(about))

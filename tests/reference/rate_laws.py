"""Rate-dependent plants of several laws and maps, written with the paper's equations alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

import hyst
from reference.rate_dependent_plays import ACTUATOR, output, rate

Array = NDArray[np.float64]
Law = Callable[[Array], Array]
Map = Callable[[Array], Array]

OFFSET = 0.3
NOISE = 0.05
"""Of the output, 0.06 % of its range."""

SQUARE_ROOT, SLOPE, BEND, BETA = 0.13, 2e-3, 4000.0, 8.572e-4

LAWS: dict[str, Law] = {
    "linear": lambda x: BETA * x,
    "sqrt": lambda x: SQUARE_ROOT * np.sqrt(x),
    "rational": lambda x: SLOPE * x / (1.0 + x / BEND),
    "exponential": lambda x: SLOPE * BEND * (1.0 - np.exp(-x / BEND)),
}

RECORDS = ((1.0, 1.7, 1e-3), (50.0, 10.0, 1e-4), (100.0, 10.0, 1e-4))
"""Frequency, Hz, periods and sample time, s."""


def same(signal: Array) -> Array:
    """No map."""
    return signal


def plant(u: Array, dt: float, law: Law, before: Map = same, after: Map = same) -> Array:
    """The actuator of S4 sec. IV-C with another law, and maps before and after it."""
    v = before(u)
    y = output(ACTUATOR["p"], ACTUATOR["r"], ACTUATOR["p0"], v, law(rate(v, dt)))
    return after(y) + OFFSET


def sine(frequency: float, periods: float, dt: float, amplitude: float = 40.0) -> Array:
    """A sine from 0 on."""
    time = np.arange(round(periods / frequency / dt)) * dt
    return amplitude * np.sin(2.0 * np.pi * frequency * time)


def triangle(frequency: float, periods: float, dt: float, amplitude: float = 40.0) -> Array:
    """A triangle from its top on, whose corners are between samples."""
    phase = np.arange(round(periods / frequency / dt)) * dt * frequency + 0.003
    return amplitude * (4.0 * np.abs(phase % 1.0 - 0.5) - 1.0)


def records(
    law: Law,
    seed: int,
    *,
    noise: float = NOISE,
    drive_noise: float = 0.0,
    shape: Callable[..., Array] = sine,
    before: Map = same,
    after: Map = same,
    runs: Sequence[tuple[float, float, float]] = RECORDS,
) -> list[hyst.Record]:
    """Records of a plant, noise on the output and on what is measured of the drive."""
    random = np.random.default_rng(seed)
    made = []
    for frequency, periods, dt in runs:
        u = shape(frequency, periods, dt)
        y = plant(u, dt, law, before, after) + noise * random.normal(size=u.size)
        made.append(hyst.Record(u + drive_noise * random.normal(size=u.size), y, dt=dt))
    return made


def estimates(found: hyst.Identified) -> dict[str, tuple[float, float]]:
    """Values and standard errors by the last part of their names."""
    rows = zip(found.parameter_names, found.parameter_values, found.standard_errors, strict=True)
    return {name.split(".")[-1]: (float(value), float(error)) for name, value, error in rows}

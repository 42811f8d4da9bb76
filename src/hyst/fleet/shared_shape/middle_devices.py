"""Scatter and mean of a fleet from the devices that belong to it.

The half of the devices that lies together is found first, its scatter is widened to what the
middle of the fleet shows, and devices are taken in as long as they are not too far for it: so
devices of another kind, of which there may be many, do not widen the scatter behind which they
would then hide.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.fleet.shared_shape.device_equations import Equations
from hyst.fleet.shared_shape.noise import Noise, noise_of
from hyst.fleet.shared_shape.population import Population
from hyst.fleet.shared_shape.variance_components import (
    BY_CHANCE,
    Scatter,
    estimate_scatter,
    shared_where_possible,
)

Array = NDArray[np.float64]

UNLIKELY = 1e-3
"""Probability below which a device does not count for mean and scatter."""

MOST_DEVICES = 240
"""On which variances are estimated; the mean takes all."""

ROUNDS = 4
FEW_STEPS, STEPS = 12, 60


@dataclass(frozen=True, eq=False)
class Middle:
    """What the devices have in common.

    Parameters
    ----------
    scatter
        Of those that belong to it.
    population
        The same, around its own mean.
    belongs
        Shape (devices,).
    """

    scatter: Scatter
    population: Population
    belongs: NDArray[np.bool_]


def middle_of(equations: Equations, start: Scatter) -> Middle:
    """Find the devices that belong together, with their mean and scatter.

    Parameters
    ----------
    equations
        Of all devices.
    start
        Directions and first variances.

    Notes
    -----
    Concentration steps from the half of least distance: P. J. Rousseeuw, K. van Driessen,
    Technometrics 41 (1999), 212-223.
    """
    noise = noise_of(equations)
    count = len(equations.samples)
    half = min(count, max(count // 2 + 1, 6))
    alike = noise.chance(equations) > UNLIKELY
    belongs = _nearest(equations.error / equations.samples, alike, half)
    scatter = start
    for _ in range(ROUNDS):
        scatter, population = _estimated(equations, noise, belongs, scatter, FEW_STEPS)
        around = moved(equations, scatter.mean)
        widened = population.excess(around)[alike]
        scatter, population = _widened(scatter, population, float(np.median(widened)))
        belongs = _nearest(population.excess(around), alike, half)
    for _ in range(ROUNDS):
        scatter, population = _estimated(equations, noise, belongs, scatter, STEPS)
        around = moved(equations, scatter.mean)
        stretch = max(1.0, float(np.median(population.excess(around)[belongs])))
        population = replace(population, stretch=stretch)
        before, belongs = belongs, alike & (population.chance(around) > UNLIKELY)
        if belongs.sum() < half:
            belongs = _nearest(population.excess(around), alike, half)
        if (belongs == before).all():
            break
    return Middle(scatter, population, belongs)


def simplest(equations: Equations, middle: Middle, starts: Sequence[Array]) -> Middle:
    """Give the scatter that says as much with the fewest variances.

    Parameters
    ----------
    equations
        Of all devices.
    middle
        What they have in common.
    starts
        Variances to start from, beside those of the middle.
    """
    of_them = equations.of(middle.belongs)
    few, weights = _some(of_them)
    noise = noise_of(of_them)
    found = []
    for start in (middle.scatter.variances, *starts):
        scatter = replace(middle.scatter, variances=start)
        scatter = estimate_scatter(few, noise.of(few), weights, scatter, STEPS)
        scatter = shared_where_possible(few, noise.of(few), weights, scatter)
        paid = 0.5 * BY_CHANCE * np.count_nonzero(scatter.variances)
        found.append((scatter.likelihood - paid, scatter))
    best = max(found, key=lambda each: each[0])[1]
    scatter, population = _estimated(equations, noise, middle.belongs, best, 0)
    return Middle(scatter, population, middle.belongs)


def _some(equations: Equations) -> tuple[Equations, Array]:
    """Give devices enough for variances, spread evenly, and weights of 1."""
    count = len(equations.samples)
    places = np.linspace(0, count - 1, min(count, MOST_DEVICES)).round()
    some = np.unique(places.astype(np.intp))
    return equations.of(some), np.ones(some.size)


def _estimated(
    equations: Equations, noise: Noise, belongs: NDArray[np.bool_], start: Scatter, most: int
) -> tuple[Scatter, Population]:
    of_them = equations.of(belongs)
    few, weights = _some(of_them)
    scatter = estimate_scatter(few, noise.of(few), weights, start, most)
    every = np.ones(len(of_them.samples))
    if weights.size < every.size:
        scatter = estimate_scatter(of_them, noise.of(of_them), every, scatter, 0)
    return scatter, Population(scatter.covariance, noise)


def moved(equations: Equations, mean: Array) -> Equations:
    """Give the equations around another mean.

    Parameters
    ----------
    equations
        Of devices.
    mean
        Shape (q,), where it is from where they count.
    """
    return replace(equations, along=equations.along - equations.rows @ mean)


def _widened(scatter: Scatter, population: Population, excess: float) -> tuple[Scatter, Population]:
    """Widen the scatter of the half that lies together to what the whole fleet's middle shows."""
    if excess <= 1.0:
        return scatter, population
    wider = replace(scatter, variances=scatter.variances * excess)
    return wider, replace(population, covariance=wider.covariance)


def _nearest(distances: Array, alike: NDArray[np.bool_], count: int) -> NDArray[np.bool_]:
    """Give the nearest devices, those that are alike in what they leave first."""
    order = np.lexsort((distances, ~alike))
    nearest = np.zeros(distances.size, dtype=bool)
    nearest[order[:count]] = True
    return nearest

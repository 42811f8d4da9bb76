"""The shape of a fleet and how its devices differ, from records of all of them.

Devices are linearised where they are taken to be, mean and scatter estimated, devices estimated
anew, until the mean rests: M. J. Lindstrom, D. M. Bates, Biometrics 46 (1990), 673-687.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.fleet.shared_shape.device_equations import Equations, equations_of
from hyst.fleet.shared_shape.free_constants import SCALES, FreeConstants
from hyst.fleet.shared_shape.middle_devices import (
    UNLIKELY,
    Middle,
    middle_of,
    moved,
    simplest,
)
from hyst.fleet.shared_shape.population import Population
from hyst.fleet.shared_shape.signals_used import Used
from hyst.fleet.shared_shape.variance_components import Scatter

Array = NDArray[np.float64]

FIRST_SCATTER, FIRST_OF_ONE = 0.05, 0.01
"""Of a scale or an offset, and of another constant, as a share of it: where the estimate of its
variance starts. Several constants could do what one scale does."""

MOST_ROUNDS = 8
AT_REST = 0.05
"""Standard errors of the mean by which it still moves."""

WORSE, HARDLY_BETTER = 1.001, 0.999
"""Times the squared error of most devices: more is no step forward, and more than the second one is
hardly one."""

LARGEST_STEP = 1.0
"""Share of a constant by which the mean moves at once."""


@dataclass(frozen=True, eq=False)
class Estimated:
    """What a fleet has in common.

    Parameters
    ----------
    constants
        The mean device and the directions in which others differ.
    population
        Around it.
    scatter
        Along named directions.
    names
        Of these directions.
    belongs
        Shape (devices,), which of them counted.
    """

    constants: FreeConstants
    population: Population
    scatter: Scatter
    names: tuple[str, ...]
    belongs: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class _Round:
    """The fleet around one mean: equations, what devices have in common, error of most of them."""

    constants: FreeConstants
    equations: Equations
    middle: Middle
    cost: float

    def step(self, share: float) -> tuple[FreeConstants, Array]:
        """Give a mean some way further, and where the devices then lie."""
        constants, scatter = self.constants, self.middle.scatter
        step = constants.within(share * _limited(scatter.mean), scatter.mean_covariance)
        means, covariances = self.middle.population.posterior(moved(self.equations, step))
        further = constants.moved(step)
        pairs = zip(means, covariances, strict=True)
        return further, np.array([further.within(z, covariance) for z, covariance in pairs])

    @property
    def rests(self) -> bool:
        """Whether the mean moves by less than it is sure."""
        scatter = self.middle.scatter
        along = np.linalg.solve(scatter.mean_covariance, scatter.mean)
        return bool(float(along @ scatter.mean) <= AT_REST**2 * scatter.mean.size)


def estimate(constants: FreeConstants, fleet: list[Used], output_range: float) -> Estimated:
    """Estimate mean and scatter.

    Parameters
    ----------
    constants
        A first mean.
    fleet
        A record of each device.
    output_range
        Unit of the output.
    """
    names = constants.directions()
    scales = np.isin([name.split(".")[-1] for name in names], [*SCALES, "offset"])
    first = np.where(scales, FIRST_SCATTER, FIRST_OF_ONE) ** 2
    scatter = Scatter(np.eye(constants.size), first, np.zeros(constants.size), np.eye(0), -np.inf)
    at, share, best = np.zeros((len(fleet), constants.size)), 1.0, None
    for _ in range(MOST_ROUNDS):
        equations = linearized(constants, fleet, at, output_range)
        cost = _error_of_most(equations)
        if best is None or cost <= WORSE * best.cost:
            middle = middle_of(equations, scatter)
            settled = best is not None and cost >= HARDLY_BETTER * best.cost
            best, share = _Round(constants, equations, middle, cost), 1.0
            scatter = _restarted(middle.scatter)
            if best.rests or settled:
                break
        else:
            share /= 4.0
        constants, at = best.step(share)
    assert best is not None, "the first round is always the best so far"
    starts = (first, np.where(scales, first, 0.0))
    best = replace(best, middle=simplest(best.equations, best.middle, starts))
    around, middle = _around(best), best.middle
    belongs = middle.belongs & (around.chance(best.equations) > UNLIKELY)
    return Estimated(best.constants, around, middle.scatter, names, belongs)


def _around(found: _Round) -> Population:
    """Give the population around the mean as it is, with distances as its devices show them."""
    middle = found.middle
    belong = found.equations.of(middle.belongs)
    stretch = np.median(replace(middle.population, stretch=1.0).excess(belong))
    unsure = middle.scatter.covariance + middle.scatter.mean_covariance
    return Population(unsure, middle.population.noise, max(1.0, float(stretch)))


def _error_of_most(equations: Equations) -> float:
    """Give the mean squared error of three quarters of the devices, the better ones."""
    errors = np.sort(equations.error / equations.samples)
    return float(np.mean(errors[: max(3 * errors.size // 4, 1)]))


def linearized(
    constants: FreeConstants, fleet: list[Used], at: Array, output_range: float
) -> Equations:
    """Give the equations of all devices, each linearised where it is.

    Parameters
    ----------
    constants
        The mean.
    fleet
        A record of each device.
    at
        Shape (devices, q).
    output_range
        Unit of the output.
    """
    pairs = zip(fleet, at, strict=True)
    return Equations.stacked([equations_of(constants, u, z, output_range) for u, z in pairs])


def evenly(fleet: list[Used], most: int) -> list[Used]:
    """Give some devices, spread evenly over the fleet.

    Parameters
    ----------
    fleet
        All.
    most
        How many at most.
    """
    places = np.linspace(0, len(fleet) - 1, min(len(fleet), most)).round()
    return [fleet[int(i)] for i in np.unique(places)]


def _restarted(scatter: Scatter) -> Scatter:
    """Let variances that went to 0 in an earlier round come back."""
    least = 1e-3 * max(float(scatter.variances.max(initial=0.0)), FIRST_SCATTER**2)
    return replace(scatter, variances=np.maximum(scatter.variances, least))


def _limited(step: Array) -> Array:
    largest = float(np.abs(step).max(initial=0.0))
    return step * min(1.0, LARGEST_STEP / largest) if largest > 0.0 else step

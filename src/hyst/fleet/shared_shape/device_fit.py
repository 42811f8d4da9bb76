"""Identify one device: its record on one side, the population on the other."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.fleet.shared_shape.device_equations import Equations, equations_of
from hyst.fleet.shared_shape.free_constants import FreeConstants
from hyst.fleet.shared_shape.noise import SMALLEST_VARIANCE, noise_of
from hyst.fleet.shared_shape.population import Population
from hyst.fleet.shared_shape.signals_used import Used

Array = NDArray[np.float64]

MOST_STEPS = 15
AT_REST = 0.05
"""Of twice the logarithm of the likelihood: what a further step may still gain; it moves the device
by less than a quarter of a standard error."""

PATIENCE = 3
"""Steps in a row that gain no more, where kinks keep a step from what it promises."""

ANYWHERE = 1e3
"""Share of a constant by which a device without a population may differ from the shape."""

LARGEST_STEP = 0.5
"""Share of a constant by which a device moves at once."""


@dataclass(frozen=True, eq=False)
class DeviceFit:
    """Where a device lies.

    Parameters
    ----------
    z, covariance
        What is known of it, shapes (q,) and (q, q).
    equations
        Of its record, linearised there.
    population
        It was drawn from.
    has_population
        Whether that is one of a fleet.
    steps
        How often it was linearised.
    converged
        Whether it came to rest.
    """

    z: Array
    covariance: Array
    equations: Equations
    population: Population
    has_population: bool
    steps: int
    converged: bool

    @property
    def told_by_record(self) -> float:
        """Of how many constants the record says more than the population: the trace of the gain."""
        noise = float(self.population.noise.of(self.equations)[0])
        rows = self.equations.rows[0] / math.sqrt(noise)
        prior = self.population.covariance
        through = rows @ prior @ rows.T
        return float(np.trace(np.linalg.solve(np.eye(len(through)) + through, through)))


def fit_device(
    constants: FreeConstants, population: Population | None, used: Used, output_range: float
) -> DeviceFit:
    """Find the likeliest device of a population, by Gauss and Newton's steps.

    Parameters
    ----------
    constants
        The mean and its directions.
    population
        Around the mean; None: any device is as likely as another, and the noise is its own.
    used
        Its record.
    output_range
        Unit of the output.
    """
    known = population is not None
    z, best, lowest = np.zeros(constants.size), None, np.inf
    patience = PATIENCE
    for step in range(1, MOST_STEPS + 1):
        equations = equations_of(constants, used, z, output_range)
        around = anywhere(equations) if population is None else population
        means, covariances = around.posterior(equations)
        cost = _cost(equations, population, z)
        if best is None or cost <= lowest:
            gained, lowest = lowest - cost, cost
            patience = PATIENCE if gained > AT_REST else patience - 1
            wanted = means[0] if known else _limited(means[0], z)
            target = constants.within(wanted, covariances[0])
            rests = cost - _promised(equations, population, target) <= AT_REST
            best = DeviceFit(z, covariances[0], equations, around, known, step, rests)
        else:
            # A kink lies between: half the way back to the best device so far.
            target, patience = (z + best.z) / 2.0, patience - 1
            rests = cost - lowest <= AT_REST
        if rests or patience == 0:
            return replace(best, steps=step, converged=True)
        z = target
    assert best is not None, "the first step is always the best so far"
    return replace(best, steps=MOST_STEPS)


def anywhere(equations: Equations) -> Population:
    """Give a population in which any device is as likely as another.

    Parameters
    ----------
    equations
        Of a device, whose noise is taken for that of the population.
    """
    wide = ANYWHERE**2 * np.eye(equations.rows.shape[2])
    return Population(wide, noise_of(equations))


def _cost(
    equations: Equations, population: Population | None, z: Array, error: float | None = None
) -> float:
    """Give minus twice the logarithm of the posterior density, but for a constant.

    ``error`` is the sum of squares that the linearised record promises at z; without it, z is where
    the record was linearised.
    """
    left = float(equations.error[0]) if error is None else error
    if population is None:
        # With a variance of its own, the likeliest one.
        samples = int(equations.samples[0])
        return samples * math.log(max(left / samples, SMALLEST_VARIANCE))
    return left / float(population.noise.of(equations)[0]) + float(z @ population.precision @ z)


def _promised(equations: Equations, population: Population | None, z: Array) -> float:
    """Give the same as the linearised record promises it elsewhere."""
    missed = equations.along[0] - equations.rows[0] @ z
    return _cost(equations, population, z, float(equations.left[0]) + float(missed @ missed))


def _limited(wanted: Array, z: Array) -> Array:
    step = wanted - z
    largest = float(np.abs(step).max(initial=0.0))
    return wanted if largest <= LARGEST_STEP else z + step * (LARGEST_STEP / largest)

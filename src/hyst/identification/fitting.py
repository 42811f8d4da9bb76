"""Fit one family of a given size to records."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.bounded_least_squares import CONVERGED, Problem, Solution, minimize
from hyst.identification.data import Data
from hyst.identification.families import (
    GPI,
    LINEAR,
    MPI,
    RAMBERG_OSGOOD,
    Parametrization,
    Start,
    parametrize,
    parametrize_power_law,
)
from hyst.identification.radius_search import search_radii
from hyst.identification.separable import PowerLawOptions, fit_power_law
from hyst.identification.weight_rules import INVERTIBLE, NON_NEGATIVE, RULES
from hyst.identification.weights import Weights, fit_weights
from hyst.models import PrandtlIshlinskii
from hyst.operators import Operator
from hyst.operators.composition import leaves_of
from hyst.signals import reversals

Array = NDArray[np.float64]

FINE_BANK = 60

MOST_STARTS = 3

AUTO = "auto"

NEGATIVE_WEIGHTS_PAY = 0.9
"""Negative weights are allowed where they lower the residual of a fine bank below this share."""

ROUNDING = 1e-12
"""A residual of this share of the output range is rounding."""


@dataclass(frozen=True, eq=False)
class Fit:
    """One family fitted: its parametrization, where the iteration ended, and how well.

    Parameters
    ----------
    family
        The family.
    parametrization, solution
        Free parameters and their best values.
    """

    family: str
    parametrization: Parametrization
    solution: Solution

    @property
    def operator(self) -> Operator:
        """The fitted operator."""
        return self.parametrization.operator(self.solution.theta)


def model_output(data: Data, operator: Operator) -> Array:
    """Give the model's output over the samples used, all records one after the other.

    Parameters
    ----------
    data
        The records.
    operator
        The model.

    Returns
    -------
    numpy.ndarray
        Shape (samples used,).
    """
    return np.concatenate(
        [operator(r.u[: w.stop])[w] for r, w in zip(data.records, data.windows(), strict=True)]
    )


def model_jacobian(data: Data, operator: Operator) -> Array:
    """Give the derivative of ``model_output`` by the operator's constants.

    Parameters
    ----------
    data
        The records.
    operator
        The model.

    Returns
    -------
    numpy.ndarray
        Shape (samples used, constants).
    """
    return np.concatenate(
        [
            operator.jacobian(r.u[: w.stop])[w]
            for r, w in zip(data.records, data.windows(), strict=True)
        ]
    )


def problem_of(
    data: Data, parametrization: Parametrization, chosen: NDArray[np.bool_] | None = None
) -> Problem:
    """Pose the least squares problem of a parametrization over all or some samples.

    Parameters
    ----------
    data
        The records.
    parametrization
        Free parameters of a family.
    chosen
        Shape (samples used,): which samples count; all if left out.

    Returns
    -------
    Problem
    """
    y = data.measured()
    rows: NDArray[np.bool_] | slice = slice(None) if chosen is None else chosen
    target = y[rows]

    def residual(theta: Array) -> Array:
        return model_output(data, parametrization.operator(theta))[rows] - target

    def linearize(theta: Array) -> tuple[Array, Array]:
        jacobian = model_jacobian(data, parametrization.operator(theta))[rows]
        return residual(theta), jacobian @ parametrization.transform

    return Problem(
        linearize,
        residual,
        parametrization.lower,
        parametrization.upper,
        parametrization.canonical,
        negligible=float(target.size * (ROUNDING * np.ptp(y)) ** 2),
    )


@dataclass(frozen=True, eq=False)
class Fitter:
    """Fits families to the same records, sharing what does not depend on the family.

    Parameters
    ----------
    data
        The records.
    knots
        Number of knots of the map of ``gpi`` and ``mpi``.
    radii
        Shape (n,), radii to keep, input units; None if they are to be found.
    wanted_rule
        What the weights may be: ``non-negative``, ``invertible`` or ``auto``.
    power_law
        How a power law is identified, for ``ramberg-osgood``.
    """

    data: Data
    knots: int
    radii: Array | None = None
    wanted_rule: str = AUTO
    power_law: PowerLawOptions = field(default_factory=PowerLawOptions)

    def fit(self, family: str, plays: int, starts: int = 1, max_iterations: int = 100) -> Fit:
        """Fit a family with a given number of plays; the best of several starts is kept.

        Parameters
        ----------
        family
            ``linear``, ``ramberg-osgood``, ``pi``, ``gpi`` or ``mpi``.
        plays
            Number of plays.
        starts
            How many first guesses of the radii to try, at most ``MOST_STARTS``. They are the same
            in every run.
        max_iterations
            For each start.

        Returns
        -------
        Fit
        """
        if family == RAMBERG_OSGOOD:
            return self._fit_power_law(max_iterations)
        guesses = self._first_radii(0 if family == LINEAR else plays)[:starts]
        fits = [self._fit_from(family, r, max_iterations) for r in guesses]
        return min(fits, key=lambda fit: fit.solution.cost)

    def improve(self, fit: Fit, max_iterations: int = 100) -> Fit:
        """Move the radii of a fit across the kinks of the cost.

        Parameters
        ----------
        fit
            An earlier fit.
        max_iterations
            At most, for each fit after a move.

        Returns
        -------
        Fit
            At least as good.
        """
        problem = problem_of(self.data, fit.parametrization)
        kinks = np.unique(
            np.concatenate([_half_swings(fit.operator, record.u) for record in self.data.records])
        )
        plays = fit.parametrization.plays
        solution = search_radii(problem, fit.solution, plays, kinks, max_iterations)
        return replace(fit, solution=solution)

    def polish(self, fit: Fit, max_iterations: int = 100) -> Fit:
        """Go on from a fit of other samples of the same records.

        Parameters
        ----------
        fit
            A fit, for instance of thinned records.
        max_iterations
            At most.

        Returns
        -------
        Fit
        """
        problem = problem_of(self.data, fit.parametrization)
        return replace(fit, solution=minimize(problem, fit.solution.theta, max_iterations))

    def refit(self, fit: Fit, plays: NDArray[np.bool_], max_iterations: int = 100) -> Fit:
        """Fit a family again with some of its plays only.

        Parameters
        ----------
        fit
            An earlier fit.
        plays
            Shape (n,), bool: which plays stay.
        max_iterations
            At most.

        Returns
        -------
        Fit
        """
        theta, of = fit.solution.theta, fit.parametrization
        weights, r = of.weights(theta), of.radii(theta)
        start = replace(
            self._start(fit.family, self._weights(r)),
            p0=float(weights[0]),
            p=weights[1:][plays],
            r=r[plays],
        )
        parametrization, refitted = parametrize(fit.family, start)
        rest = theta.size - 2 * of.plays - 1
        refitted[-rest:] = theta[-rest:]
        solution = minimize(problem_of(self.data, parametrization), refitted, max_iterations)
        return Fit(fit.family, parametrization, solution)

    @functools.cached_property
    def sign(self) -> float:
        """+1 where the output rises with the input, -1 where it falls."""
        windows = zip(self.data.records, self.data.windows(), strict=True)
        u = np.concatenate([record.u[window] for record, window in windows])
        return 1.0 if float(np.dot(u - u.mean(), self.data.measured())) >= 0.0 else -1.0

    @functools.cached_property
    def rule(self) -> str:
        """What the weights may be; ``auto`` allows negative ones where they help a lot."""
        if self.wanted_rule != AUTO:
            return self.wanted_rule
        plain, free = (self._fine_weights[rule].rms for rule in (NON_NEGATIVE, INVERTIBLE))
        return INVERTIBLE if free < NEGATIVE_WEIGHTS_PAY * plain else NON_NEGATIVE

    @functools.cached_property
    def _fine_weights(self) -> dict[str, Weights]:
        """Weights of a bank finer than any model, under either rule."""
        return {rule: fit_weights(self.data, self._fine_radii, self.sign, rule) for rule in RULES}

    @property
    def _fine_radii(self) -> Array:
        return self.data.largest_radius * np.arange(1, FINE_BANK + 1) / (FINE_BANK + 1)

    def _weights(self, r: Array) -> Weights:
        return fit_weights(self.data, r, self.sign, self.rule)

    def _first_radii(self, plays: int) -> list[Array]:
        """First guesses: equal shares of the curvature, evenly spaced, denser at small radii."""
        if self.radii is not None:
            return [self.radii]
        if plays == 0:
            return [np.empty(0)]
        largest = self.data.largest_radius
        curvature = np.abs(self._fine_weights[self.rule].p)
        # A floor keeps the radii apart where the bank puts all weight on a few plays.
        share = np.cumsum(curvature + 0.5 * max(curvature.mean(), np.finfo(float).tiny))
        levels = share[-1] * (np.arange(plays) + 0.5) / plays
        even = largest * np.arange(1, plays + 1) / (plays + 1)
        return [np.interp(levels, share, self._fine_radii), even, even**2 / largest]

    def _fit_from(self, family: str, r: Array, max_iterations: int) -> Fit:
        start = replace(self._start(family, self._weights(r)), r=r)
        parametrization, theta = parametrize(family, start)
        # A coefficient that starts on its bound would give its radius no derivative.
        coefficients = theta[: r.size + 1]
        theta[: r.size + 1] = np.maximum(coefficients, 0.01 * start.mean_slope)
        solution = minimize(problem_of(self.data, parametrization), theta, max_iterations)
        return Fit(family, parametrization, solution)

    def _fit_power_law(self, max_iterations: int) -> Fit:
        """Fit by variable projection; a fit of the output then ends in all constants at once."""
        found = fit_power_law(self.data, self.power_law, self.sign)
        parametrization, theta = parametrize_power_law(
            found, self.sign, self._mean_slope, self.power_law.memory
        )
        problem = problem_of(self.data, parametrization)
        if self.power_law.regression == "slope":
            residual = problem.residual(theta)
            cost = float(residual @ residual)
            solution = Solution(theta, cost, found.evaluations, CONVERGED)
        else:
            solution = minimize(problem, theta, max_iterations)
        return Fit(RAMBERG_OSGOOD, parametrization, solution)

    @property
    def _mean_slope(self) -> float:
        return float(np.ptp(self.data.measured())) / (2.0 * self.data.half_range)

    def _start(self, family: str, weights: Weights) -> Start:
        return Start(
            p0=weights.p0,
            p=weights.p,
            r=np.empty(0),
            offset=weights.offset,
            sign=self.sign,
            knots=self._knots(family, weights),
            largest_radius=self.data.largest_radius,
            mean_slope=self._mean_slope,
            rule=self.rule,
            fixed_radii=self.radii is not None,
        )

    def _knots(self, family: str, weights: Weights) -> Array:
        """Knots of the map, evenly spaced over the signal it acts on; none at 0."""
        if family == GPI:
            signal = np.concatenate([record.u for record in self.data.records])
        elif family == MPI:
            signal = self.sign * (self.data.measured() - weights.offset)
        else:
            return np.empty(0)
        low, high = float(signal.min()), float(signal.max())
        knots = np.linspace(low, high, self.knots + 2)[1:-1]
        return np.asarray(knots[np.abs(knots) > 1e-6 * (high - low)])


def _half_swings(operator: Operator, u: Array) -> Array:
    """Give half the swings of the signal the plays of a model are driven by."""
    signal = u
    for leaf in leaves_of(operator):
        if isinstance(leaf, PrandtlIshlinskii):
            break
        signal = leaf(signal)
    return np.abs(np.diff(signal[reversals(signal)])) / 2.0

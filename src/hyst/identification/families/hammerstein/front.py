"""Step 5, first half: the hysteresis in front of the dynamics, fitted to input and estimated v."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.families import GPI, LINEAR, MPI, PI, Parametrization
from hyst.identification.families.ramberg_osgood import SMALLEST_POWER, largest_power
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.problem import Fitter, problem_of
from hyst.identification.record_use.used_samples import LARGEST_RADIUS, prepare
from hyst.models import GeneralizedPrandtlIshlinskii, PrandtlIshlinskii, RambergOsgood
from hyst.operators import Affine, DeadZone, Operator
from hyst.signals import Record

Array = NDArray[np.float64]

RAMBERG_OSGOOD = "ramberg-osgood"
FRONTS = (LINEAR, PI, GPI, MPI, RAMBERG_OSGOOD)

LONGEST_START = 20_000
"""Samples the first fit is made on; the joint refinement takes them all."""


@dataclass(frozen=True, eq=False)
class Front:
    """A hysteresis with free parameters and a first guess.

    Parameters
    ----------
    family
        One of ``FRONTS``.
    parametrization
        Free parameters.
    theta
        First guess.
    gauge
        Shape (m,): ``gauge @ theta = 1`` fixes a scale that data cannot; None where there is none.
    """

    family: str
    parametrization: Parametrization
    theta: Array
    gauge: Array | None = None


@dataclass(frozen=True, eq=False)
class FrontOptions:
    """What the user wants of the hysteresis.

    Parameters
    ----------
    family
        One of ``FRONTS``.
    plays
        Number of plays.
    knots
        Number of knots of a map, or where they lie, input units (``gpi`` only).
    radii
        Shape (n,): radii to keep; None if they are to be found.
    rule
        As ``weights`` of ``identify``.
    """

    family: str
    plays: int
    knots: int | Array
    radii: Array | None
    rule: str


def first_front(u: Array, v: Array, dt: float, options: FrontOptions) -> Front:
    """Fit a hysteresis to the input and the estimated signal behind it.

    Parameters
    ----------
    u, v
        Shape (N,), from the beginning of a record on.
    dt
        Sample time, s.
    options
        What is wanted.

    Returns
    -------
    Front

    Raises
    ------
    InputError
        If the family is not known.
    """
    if options.family not in FRONTS:
        raise InputError(f"hysteresis is {options.family!r}; choose one of {', '.join(FRONTS)}")
    record = Record(u[:LONGEST_START], v[:LONGEST_START], dt)
    return _STARTS.get(options.family, _by_family)(record, options)


def _by_family(record: Record, options: FrontOptions) -> Front:
    knots = options.knots if isinstance(options.knots, int) else len(options.knots)
    fitter = Fitter(prepare(record, "auto", 0), knots, options.radii, options.rule)
    fit = fitter.fit(options.family, options.plays, max_iterations=30)
    return Front(options.family, fit.parametrization, fit.solution.theta)


def _generalized(record: Record, options: FrontOptions) -> Front:
    """Fit a map of any shape, monotone or not, before plays whose weights sum up to 1."""
    knots = _knots(record.u, options.knots)
    weights, offset = _fit_map(record, knots)
    z = DeadZone(weights, np.concatenate([[0.0], knots]))(record.u)
    plays = Fitter(
        prepare(Record(z, record.y, record.dt), "auto", 0), 0, _scaled(options.radii, record.u, z)
    )
    fit = plays.fit(PI, options.plays, max_iterations=30)
    found = fit.parametrization.weights(fit.solution.theta)
    scale = float(found.sum()) * plays.sign
    pi = PrandtlIshlinskii(
        found[1:] / abs(scale),
        fit.parametrization.radii(fit.solution.theta) * abs(scale),
        found[0] / abs(scale),
    )
    envelope = DeadZone(scale * weights, np.concatenate([[0.0], knots]))
    template = Affine(1.0, offset) @ GeneralizedPrandtlIshlinskii(envelope, pi)
    return _free_envelope(template, knots.size + 1, pi, float(np.ptp(z)) * abs(scale), options)


def _free_envelope(
    template: Operator,
    map_size: int,
    pi: PrandtlIshlinskii,
    swing: float,
    options: FrontOptions,
) -> Front:
    n = pi.p.size
    values = template.parameters().values.copy()
    # Constants: weights and thresholds of the map, p0, p, r, gain, offset.
    plays_at = 2 * map_size
    places = [*range(plays_at, plays_at + 1 + 2 * n), *range(map_size)]
    if isinstance(options.knots, int):
        places += range(map_size + 1, 2 * map_size)
    places += [values.size - 1]
    transform = np.zeros((values.size, len(places)))
    transform[places, np.arange(len(places))] = 1.0
    theta = values[places]
    values[places] = 0.0
    lower, upper = np.full(theta.size, -np.inf), np.full(theta.size, np.inf)
    lower[: n + 1] = 0.0
    radii = slice(n + 1, 2 * n + 1)
    lower[radii], upper[radii] = 1e-4 * swing / 2.0, LARGEST_RADIUS * swing / 2.0
    if options.radii is not None:
        lower[radii] = upper[radii] = theta[radii]
    if isinstance(options.knots, int):
        knots = slice(2 * n + 1 + map_size, theta.size - 1)
        lower[knots], upper[knots] = _reach(theta[knots])
    theta[radii] = np.clip(theta[radii], lower[radii], upper[radii])
    parametrization = Parametrization(
        template,
        transform,
        values,
        lower,
        upper,
        np.eye(n + 1),
    )
    gauge = np.zeros(theta.size)
    gauge[: n + 1] = 1.0
    return Front(GPI, parametrization, theta, gauge)


def _ramberg_osgood(record: Record, _: FrontOptions) -> Front:
    slope, offset = np.polyfit(record.u, record.y, 1)
    swing = float(np.ptp(record.u))
    sign = 1.0 if slope >= 0.0 else -1.0
    model = RambergOsgood(0.7 * abs(slope), 0.6 * abs(slope) / swing, 1.0)
    template = Affine(sign, float(offset)) @ model
    constants = template.parameters().values
    transform = np.zeros((5, 4))
    transform[[0, 1, 2, 4], np.arange(4)] = 1.0
    data = prepare(record, "auto", 0)
    lower = np.array([1e-3 * abs(slope), 0.0, SMALLEST_POWER, -np.inf])
    parametrization = Parametrization(
        template,
        transform,
        np.array([0.0, 0.0, 0.0, sign, 0.0]),
        lower,
        np.array([np.inf, np.inf, largest_power(data), np.inf]),
        np.eye(1),
    )
    problem = problem_of(data, parametrization)
    theta = minimize(problem, constants[[0, 1, 2, 4]], 60).theta
    return Front(RAMBERG_OSGOOD, parametrization, theta)


_STARTS: dict[str, Callable[[Record, FrontOptions], Front]] = {
    GPI: _generalized,
    RAMBERG_OSGOOD: _ramberg_osgood,
}


def _knots(u: Array, knots: int | Array) -> Array:
    """Knots at equal shares of the samples, or those given; none at 0, where the map starts."""
    if isinstance(knots, int):
        shares = np.arange(1, knots + 1) / (knots + 1)
        # Half evenly over the range: a map bends where the input seldom is, too.
        even = np.linspace(u.min(), u.max(), knots + 2)[1:-1]
        places = 0.5 * (np.quantile(u, shares) + even)
    else:
        places = np.unique(knots)
    span = float(np.ptp(u))
    return places[np.abs(places) > 1e-6 * span]


def _reach(knots: Array) -> tuple[Array, Array]:
    """Let each knot move to halfway to its neighbours, and not across 0."""
    fence = np.sort(np.append(knots, 0.0))
    halves = 0.5 * (fence[1:] + fence[:-1])
    edges = np.concatenate([[1.5 * fence[0]], halves, [1.5 * fence[-1]]])
    place = np.searchsorted(fence, knots)
    lower, upper = edges[place], edges[place + 1]
    return np.minimum(lower, knots), np.maximum(upper, knots)


def _fit_map(record: Record, knots: Array) -> tuple[Array, float]:
    """Weights of the map by least squares, the hysteresis taken as noise."""
    u = record.u[:, None]
    ramps = np.where(knots > 0.0, np.maximum(u - knots, 0.0), np.minimum(u - knots, 0.0))
    columns = np.column_stack([record.u, ramps, np.ones(len(record))])
    scale = np.maximum(np.abs(columns).max(axis=0), np.finfo(np.float64).tiny)
    solution = np.linalg.lstsq(columns / scale, record.y, rcond=1e-10)[0] / scale
    return solution[:-1], float(solution[-1])


def _scaled(radii: Array | None, u: Array, z: Array) -> Array | None:
    """Radii given are those of the plays for a map whose output spans what its input spans."""
    return None if radii is None else radii * float(np.ptp(z)) / float(np.ptp(u))

"""The families of models: how free parameters become the constants of an operator.

For every family the constants of the operator are an affine function of the free parameters,
``constants = fixed + transform @ theta``, so the Jacobian by theta is the operator's own Jacobian
times ``transform``, and bounds on theta keep every iterate invertible. Scales that only shift a
factor from one stage to the next are fixed: the slope of a map around 0 is 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.separable import SMALLEST_POWER, PowerLawFit
from hyst.identification.weight_rules import NON_NEGATIVE, basis
from hyst.models import (
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    PrandtlIshlinskii,
    RambergOsgood,
)
from hyst.models.masing import as_mode
from hyst.operators import Affine, DeadZone, Operator

Array = NDArray[np.float64]

LINEAR, PI, GPI, MPI = "linear", "pi", "gpi", "mpi"
FAMILIES = (LINEAR, PI, GPI, MPI)
"""From the simplest to the richest: what ``auto`` compares."""

RAMBERG_OSGOOD = "ramberg-osgood"
"""Without plays, and only if it is asked for by name."""

WITHOUT_PLAYS = (LINEAR, RAMBERG_OSGOOD)

KNOWN = (LINEAR, RAMBERG_OSGOOD, PI, GPI, MPI)
"""All there are; between equally good ones with as many parameters the earlier is taken."""

SMALLEST_MAP_SLOPE = 0.02
"""Of an envelope or output map, whose slope around 0 is 1."""

SMALLEST_SLOPE = 1e-3
"""Least p0 (or slope of the loading curve, if the rule is ``invertible``) as a share of the mean
slope of the records: it bounds the gain of the inverse."""


@dataclass(frozen=True, eq=False)
class Parametrization:
    """Free parameters of a family and the operator they make.

    Parameters
    ----------
    template
        An operator of the family; its constants are replaced.
    transform, fixed
        Shapes (constants, m) and (constants,).
    lower, upper
        Shape (m,), bounds of theta.
    basis
        Shape (n + 1, n + 1): theta starts with a_0 .. a_n, r_1 .. r_n, and ``(p0, p) = basis @ a``.
    """

    template: Operator
    transform: Array
    fixed: Array
    lower: Array
    upper: Array
    basis: Array

    @property
    def plays(self) -> int:
        """Number of plays n."""
        return int(self.basis.shape[0] - 1)

    def weights(self, theta: Array) -> Array:
        """Give p0, p_1 .. p_n."""
        return np.asarray(self.basis @ theta[: self.plays + 1])

    def radii(self, theta: Array) -> Array:
        """Give r_1 .. r_n."""
        return np.asarray(theta[self.plays + 1 : 2 * self.plays + 1])

    @property
    def size(self) -> int:
        """Number of free parameters."""
        return int(self.lower.size)

    def constants(self, theta: Array) -> Array:
        """Give the operator's parameter vector."""
        vector: Array = self.fixed + self.transform @ theta
        return vector

    def operator(self, theta: Array) -> Operator:
        """Give the operator for sorted theta."""
        return self.template.with_parameters(self.constants(theta))

    def canonical(self, theta: Array) -> Array:
        """Sort the plays by radius, each with its weight: their order means nothing."""
        n, r = self.plays, self.radii(theta)
        order = np.argsort(r, kind="stable")
        if (order[1:] > order[:-1]).all():
            return theta
        weights = self.weights(theta)
        sorted_theta = theta.copy()
        in_order = np.concatenate([weights[:1], weights[1:][order]])
        sorted_theta[: n + 1] = np.linalg.solve(self.basis, in_order)
        sorted_theta[n + 1 : 2 * n + 1] = r[order]
        return np.clip(sorted_theta, self.lower, self.upper)


@dataclass(frozen=True, eq=False)
class Start:
    """A first guess: plays and offset of a PI model, and the knots of a map.

    Parameters
    ----------
    p0, p, r, offset
        Of ``y = sign (p0 u + sum_i p_i z_i) + offset``.
    sign
        +1, or -1 where the output falls as the input rises.
    knots
        Thresholds of the map, none of them 0: in input units for ``gpi``, in output units without
        the offset for ``mpi``.
    largest_radius
        Upper bound of the radii, input units.
    mean_slope
        Output range over input range of the records.
    rule
        What the weights may be: ``non-negative`` or ``invertible``.
    fixed_radii
        Whether the radii are to stay as they are.
    """

    p0: float
    p: Array
    r: Array
    offset: float
    sign: float
    knots: Array
    largest_radius: float
    mean_slope: float
    rule: str = NON_NEGATIVE
    fixed_radii: bool = False


def parametrize(family: str, start: Start) -> tuple[Parametrization, Array]:
    """Give the parametrization of a family and theta for a first guess.

    Parameters
    ----------
    family
        ``linear``, ``pi``, ``gpi`` or ``mpi``.
    start
        The first guess; a map starts as the identity.

    Returns
    -------
    Parametrization
    theta : numpy.ndarray
    """
    return _PARTS[family](start)


def _pi(start: Start) -> tuple[Parametrization, Array]:
    pi = PrandtlIshlinskii(start.p, start.r, start.p0)
    template = Affine(start.sign, start.offset) @ pi
    return _assemble(template, start, map_at=None)


def _gpi(start: Start) -> tuple[Parametrization, Array]:
    pi = PrandtlIshlinskii(start.p, start.r, start.p0)
    envelope = _identity_map(start.knots)
    template = Affine(start.sign, start.offset) @ GeneralizedPrandtlIshlinskii(envelope, pi)
    return _assemble(template, start, map_at=0)


def _mpi(start: Start) -> tuple[Parametrization, Array]:
    pi = PrandtlIshlinskii(start.p, start.r, start.p0)
    output_map = _identity_map(start.knots)
    template = Affine(start.sign, start.offset) @ ModifiedPrandtlIshlinskii(pi, output_map)
    return _assemble(template, start, map_at=1 + 2 * pi.p.size)


def _linear(start: Start) -> tuple[Parametrization, Array]:
    template = Affine(start.sign * start.p0, start.offset)
    return (
        Parametrization(
            template=template,
            transform=np.array([[start.sign, 0.0], [0.0, 1.0]]),
            fixed=np.zeros(2),
            lower=np.array([SMALLEST_SLOPE * start.mean_slope, -np.inf]),
            upper=np.full(2, np.inf),
            basis=np.eye(1),
        ),
        np.array([start.p0, start.offset]),
    )


def parametrize_power_law(
    fit: PowerLawFit, sign: float, mean_slope: float, memory: str
) -> tuple[Parametrization, Array]:
    """Give the parametrization of a Ramberg-Osgood model and theta = (c1, c2, c3, offset).

    Parameters
    ----------
    fit
        Where to start.
    sign
        +1, or -1 where the output falls as the input rises.
    mean_slope
        Of the records, output units per input unit.
    memory
        How reversals are remembered.

    Returns
    -------
    Parametrization
    theta : numpy.ndarray
    """
    model = RambergOsgood(fit.c1, fit.c2, fit.c3, as_mode(memory), dead_band=fit.dead_band)
    transform = np.zeros((5, 4))
    transform[[0, 1, 2, 4], range(4)] = 1.0
    return (
        Parametrization(
            template=Affine(sign, fit.offset) @ model,
            transform=transform,
            fixed=np.array([0.0, 0.0, 0.0, sign, 0.0]),
            lower=np.array([SMALLEST_SLOPE * mean_slope, 0.0, SMALLEST_POWER, -np.inf]),
            upper=np.array([np.inf, np.inf, fit.largest_power, np.inf]),
            basis=np.eye(1),
        ),
        np.array([fit.c1, fit.c2, fit.c3, fit.offset]),
    )


def at_limit_of_power(parametrization: Parametrization, theta: Array) -> tuple[str, ...]:
    """Say if the exponent of a power law ended at a limit, so that it is no estimate.

    Parameters
    ----------
    parametrization, theta
        A fit of a Ramberg-Osgood model.

    Returns
    -------
    tuple of str
        A sentence, or nothing.
    """
    low, high, c3 = parametrization.lower[2], parametrization.upper[2], theta[2]
    margin = 1e-3 * c3
    if low + margin < c3 < high - margin:
        return ()
    which, shape = (
        ("upper", "the loop bends more sharply at its ends")
        if c3 >= high - margin
        else ("lower", "the slope grows more suddenly after a reversal")
    )
    return (
        f"c3 came out at its {which} limit {c3:.4g}: {shape} than a power law that this record can "
        "tell, so c3 and c2 are no estimates; compare family 'pi', or sample more often",
    )


_PARTS: dict[str, Callable[[Start], tuple[Parametrization, Array]]] = {
    LINEAR: _linear,
    PI: _pi,
    GPI: _gpi,
    MPI: _mpi,
}


def _identity_map(knots: Array) -> DeadZone:
    return DeadZone(np.concatenate([[1.0], np.zeros(knots.size)]), np.concatenate([[0.0], knots]))


def _assemble(
    template: Operator, start: Start, map_at: int | None
) -> tuple[Parametrization, Array]:
    """Lay out theta = (a, r, slopes of the map, offset) over the operator's constants."""
    n, knots = start.p.size, start.knots if map_at is not None else np.empty(0)
    fixed = template.parameters().values.copy()
    size = 2 * n + 2 + knots.size
    transform = np.zeros((fixed.size, size))
    pi_at = 2 * (knots.size + 1) if map_at == 0 else 0
    weights_of = basis(start.rule, n)
    transform[pi_at : pi_at + n + 1, : n + 1] = weights_of
    transform[pi_at + n + 1 : pi_at + 2 * n + 1, n + 1 : 2 * n + 1] = np.eye(n)
    fixed[pi_at : pi_at + 2 * n + 1] = 0.0
    if map_at is not None:
        weights = slice(map_at + 1, map_at + 1 + knots.size)
        transform[weights, 2 * n + 1 : -1], fixed[weights] = _slopes_to_weights(knots)
    transform[-1, -1], fixed[-1] = 1.0, 0.0
    free = np.linalg.solve(weights_of, np.concatenate([[start.p0], start.p]))
    theta = np.concatenate([free, start.r, np.ones(knots.size), [start.offset]])
    lower = np.zeros(size)
    lower[: 1 if start.rule == NON_NEGATIVE else n + 1] = SMALLEST_SLOPE * start.mean_slope
    lower[n + 1 : 2 * n + 1] = 1e-3 * start.largest_radius
    lower[2 * n + 1 : -1] = SMALLEST_MAP_SLOPE
    lower[-1] = -np.inf
    upper = np.full(size, np.inf)
    upper[n + 1 : 2 * n + 1] = start.largest_radius
    if start.fixed_radii:
        lower[n + 1 : 2 * n + 1] = upper[n + 1 : 2 * n + 1] = start.r
    return Parametrization(template, transform, fixed, lower, upper, weights_of), theta


def _slopes_to_weights(knots: Array) -> tuple[Array, Array]:
    """Weights at the knots from the slopes beyond them, counted outwards from slope 1 around 0."""
    count = knots.size
    transform, fixed = np.zeros((count, count)), np.zeros(count)
    for side in (1.0, -1.0):
        before = None
        for i in sorted(np.flatnonzero(side * knots > 0.0), key=lambda i: abs(knots[i])):
            transform[i, i] = 1.0
            if before is None:
                fixed[i] = -1.0
            else:
                transform[i, before] = -1.0
            before = i
    return transform, fixed

"""Free parameters of a butterfly, and the scales that no record can determine.

theta = (slopes of the envelope, p_1 .. p_n, r_1 .. r_n, c). The envelope rises by the range of the
input, and the plays make of that a state that goes from -1 to 1: both are gauges.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.parametrization import Parametrization
from hyst.models import Butterfly, GeneralizedPrandtlIshlinskii, PrandtlIshlinskii
from hyst.models.butterfly import terms
from hyst.operators import DeadZone

Array = NDArray[np.float64]

SMALLEST_RADIUS, LARGEST_RADIUS = 2e-3, 0.95
"""Of half the input range: narrower plays are the envelope itself, wider ones rest."""

LARGEST_SLOPE = 1e3
"""Of the envelope, whose mean slope is 1."""


@dataclass(frozen=True, eq=False)
class Hysteresis:
    """Envelope and plays of a butterfly, and the map of its state.

    Parameters
    ----------
    low, high
        Range of the input.
    knots
        Shape (k,), ascending, none of them 0, within the range.
    slopes
        Shape (k + 1,), of the envelope between them, >= 0.
    p, r
        Shape (n,), weights and radii of the plays, the radii in input units.
    c
        Shape (degree + 1, degree + 1).
    residual
        Root mean square of what it leaves of the records.
    """

    low: float
    high: float
    knots: Array
    slopes: Array
    p: Array
    r: Array
    c: Array
    residual: float = float("inf")

    def model(self) -> Butterfly:
        """Give the operator, its two scales as the gauges want them."""
        weights = weights_of_slopes(self.knots) @ self.unit_slopes()
        envelope = DeadZone(weights, np.concatenate([[0.0], self.knots]))
        p = self.p / float(self.p @ (self.half - self.r))
        plays = PrandtlIshlinskii(p, self.r)
        return Butterfly(GeneralizedPrandtlIshlinskii(envelope, plays), self.c)

    @property
    def half(self) -> float:
        """Half the range of the input."""
        return 0.5 * (self.high - self.low)

    def unit_slopes(self) -> Array:
        """Give the slopes of an envelope that rises by the range of the input."""
        return self.slopes * (2.0 * self.half / float(self.slopes @ self.widths()))

    def widths(self) -> Array:
        """Give the widths of the pieces of the envelope, shape (k + 1,)."""
        return np.diff(np.concatenate([[self.low], self.knots, [self.high]]))

    def with_plays(self, working: NDArray[np.bool_]) -> Hysteresis:
        """Give the same with some of the plays, each with the weight of those left out after it."""
        owner = np.maximum(np.cumsum(working) - 1, 0)
        p: Array = np.zeros(int(working.sum()))
        np.add.at(p, owner, self.p)
        return replace(self, p=p, r=self.r[working])


def weights_of_slopes(knots: Array) -> Array:
    """Give what makes weights of a dead zone, the one at 0 first, of the slopes of its pieces.

    Parameters
    ----------
    knots
        Shape (k,), ascending, none of them 0.

    Returns
    -------
    numpy.ndarray
        Shape (k + 1, k + 1).
    """
    count = knots.size
    transform = np.zeros((count + 1, count + 1))
    transform[0, int(np.searchsorted(knots, 0.0))] = 1.0
    for i, knot in enumerate(knots):
        outer, inner = (i + 1, i) if knot > 0.0 else (i, i + 1)
        transform[i + 1, outer], transform[i + 1, inner] = 1.0, -1.0
    return transform


@dataclass(frozen=True, eq=False)
class ButterflyParametrization(Parametrization):
    """A parametrization that knows its envelope and plays.

    Parameters
    ----------
    first
        What it was made from.
    """

    first: Hysteresis = None  # type: ignore[assignment]  # the fields before it have defaults

    @property
    def plays(self) -> int:
        """Number of plays."""
        return int(self.first.p.size)

    def hysteresis(self, theta: Array) -> Hysteresis:
        """Give envelope, plays and map of theta."""
        slopes, p, r = _parts(theta, self.first)
        c = np.zeros_like(self.first.c)
        c[terms(c.shape[0] - 1)] = theta[slopes.size + p.size + r.size :]
        return replace(self.first, slopes=slopes, p=p, r=r, c=c)


def parametrize_butterfly(first: Hysteresis) -> tuple[ButterflyParametrization, Array]:
    """Lay out theta over the constants of a butterfly.

    Parameters
    ----------
    first
        Where to start.

    Returns
    -------
    ButterflyParametrization
    theta : numpy.ndarray
    """
    template = first.model()
    constants = template.parameters().values
    pieces, n = first.slopes.size, first.p.size
    size = pieces + 2 * n + constants.size - (2 * pieces + 1 + 2 * n)
    # Constants: weights and thresholds of the envelope, p0, p, r, c.
    rest = slice(2 * pieces + 1, constants.size)
    transform = np.zeros((constants.size, size))
    transform[:pieces, :pieces] = weights_of_slopes(first.knots)
    transform[rest, pieces:] = np.eye(size - pieces)
    fixed = np.zeros(constants.size)
    fixed[pieces : 2 * pieces] = constants[pieces : 2 * pieces]
    lower, upper = _bounds(first, size)
    theta = np.clip(np.concatenate([first.unit_slopes(), constants[rest]]), lower, upper)
    parametrization = ButterflyParametrization(
        template,
        transform,
        fixed,
        lower,
        upper,
        partial(_sorted, first),
        gauges=partial(_scales, first),
        gauge_count=2,
        first=first,
    )
    return parametrization, theta


def _bounds(first: Hysteresis, size: int) -> tuple[Array, Array]:
    pieces, n = first.slopes.size, first.p.size
    lower, upper = np.full(size, -np.inf), np.full(size, np.inf)
    lower[: pieces + n] = 0.0
    upper[:pieces] = LARGEST_SLOPE
    radii = slice(pieces + n, pieces + 2 * n)
    lower[radii], upper[radii] = SMALLEST_RADIUS * first.half, LARGEST_RADIUS * first.half
    return lower, upper


def _parts(theta: Array, first: Hysteresis) -> tuple[Array, Array, Array]:
    pieces, n = first.slopes.size, first.p.size
    return theta[:pieces], theta[pieces : pieces + n], theta[pieces + n : pieces + 2 * n]


def _sorted(first: Hysteresis, theta: Array) -> Array:
    """Sort the plays by radius, each with its weight: their order means nothing."""
    slopes, p, r = _parts(theta, first)
    order = np.argsort(r, kind="stable")
    rest = theta[slopes.size + 2 * p.size :]
    return np.concatenate([slopes, p[order], r[order], rest])


def _scales(first: Hysteresis, theta: Array) -> tuple[Array, Array]:
    """Give by which shares the rises of envelope and state are off, with their derivatives."""
    slopes, p, r = _parts(theta, first)
    pieces, n = slopes.size, p.size
    rows = np.zeros((2, theta.size))
    rows[0, :pieces] = 0.5 * first.widths() / first.half
    rows[1, pieces : pieces + n], rows[1, pieces + n : pieces + 2 * n] = first.half - r, -p
    values = np.array([rows[0, :pieces] @ slopes - 1.0, p @ (first.half - r) - 1.0])
    return values, rows

"""Free parameters of models made of plays and a piecewise linear map.

theta = (a_0 .. a_n, r_1 .. r_n, slopes of the map, offset), with ``(p0, p) = basis @ a``. The
slopes of a map are those of its pieces, counted outwards from slope 1 around 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization
from hyst.identification.fit.weight_rules import INVERTIBLE, NON_NEGATIVE, SLIDING, basis
from hyst.models import MaxwellSlip, PrandtlIshlinskii, TwoEnvelopePrandtlIshlinskii
from hyst.operators import DeadZone, Operator
from hyst.operators.composition import leaves_of
from hyst.signals import reversals

Array = NDArray[np.float64]

SMALLEST_MAP_SLOPE = 0.02
"""Of an envelope or output map, whose slope around 0 is 1."""


@dataclass(frozen=True, eq=False)
class FirstGuess:
    """Plays and offset of a PI model, and the knots of a map that starts as the identity.

    Parameters
    ----------
    p0, p, r, offset
        Of ``y = sign (p0 u + sum_i p_i z_i) + offset``.
    sign
        +1, or -1 where the output falls as the input rises.
    knots
        Thresholds of the map, none of them 0: of an envelope in input units, of an output map in
        output units without the offset.
    largest_radius
        Upper bound of the radii, input units.
    mean_slope
        Output range over input range of the records.
    rule
        What the weights may be; see ``weight_rules``.
    fixed_radii
        Whether the radii are to stay as they are.
    input_range
        Smallest and largest input of the records, for maps that need the ends.
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
    input_range: tuple[float, float] = (0.0, 0.0)

    @property
    def plays(self) -> PrandtlIshlinskii:
        """The plays."""
        return PrandtlIshlinskii(self.p, self.r, self.p0)

    @property
    def map(self) -> DeadZone:
        """The identity, with a place for a change of slope at every knot."""
        knots = self.knots
        weights = np.concatenate([[1.0], np.zeros(knots.size)])
        return DeadZone(weights, np.concatenate([[0.0], knots]))


@dataclass(frozen=True, eq=False)
class PlayLayout:
    """Where the plays stand in theta.

    Parameters
    ----------
    basis
        Shape (n + 1, n + 1): theta starts with a_0 .. a_n, r_1 .. r_n, and ``(p0, p) = basis @ a``.
    lower, upper
        Shape (m,), bounds of theta.
    """

    basis: Array
    lower: Array
    upper: Array

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
class PlayParametrization(Parametrization):
    """A parametrization that knows its plays.

    Parameters
    ----------
    layout
        Where they stand in theta.
    """

    layout: PlayLayout = None  # type: ignore[assignment]  # the fields before it have defaults

    @property
    def radii(self) -> tuple[int, ...]:
        """Places in theta of the radii of the plays."""
        return tuple(range(self.layout.plays + 1, 2 * self.layout.plays + 1))


def parametrize_plays(
    template: Operator, guess: FirstGuess, map_at: int | None
) -> tuple[PlayParametrization, Array]:
    """Lay out theta over the constants of an operator made of plays and perhaps a map.

    Parameters
    ----------
    template
        The operator of the first guess; its last constants are gain and offset.
    guess
        The first guess.
    map_at
        Where the constants of the map begin: 0 before the plays, behind them after; None if there
        is no map.

    Returns
    -------
    PlayParametrization
    theta : numpy.ndarray
    """
    n, knots = guess.p.size, guess.knots if map_at is not None else np.empty(0)
    fixed = template.parameters().values.copy()
    size = 2 * n + 2 + knots.size
    transform = np.zeros((fixed.size, size))
    pi_at = 2 * (knots.size + 1) if map_at == 0 else 0
    weights_of = basis(guess.rule, n)
    transform[pi_at : pi_at + n + 1, : n + 1] = weights_of
    transform[pi_at + n + 1 : pi_at + 2 * n + 1, n + 1 : 2 * n + 1] = np.eye(n)
    fixed[pi_at : pi_at + 2 * n + 1] = 0.0
    if map_at is not None:
        weights = slice(map_at + 1, map_at + 1 + knots.size)
        transform[weights, 2 * n + 1 : -1], fixed[weights] = slopes_to_weights(knots)
    transform[-1, -1], fixed[-1] = 1.0, 0.0
    free = np.linalg.solve(weights_of, np.concatenate([[guess.p0], guess.p]))
    theta = np.concatenate([free, guess.r, np.ones(knots.size), [guess.offset]])
    lower, upper = bounds_of(guess, size)
    layout = PlayLayout(weights_of, lower, upper)
    return (
        PlayParametrization(
            template, transform, fixed, lower, upper, layout.canonical, layout=layout
        ),
        theta,
    )


def bounds_of(guess: FirstGuess, size: int) -> tuple[Array, Array]:
    """Give the bounds of theta: weights, radii, slopes of maps and the offset.

    Parameters
    ----------
    guess
        The first guess.
    size
        Entries of theta.
    """
    n = guess.p.size
    radii, slopes = slice(n + 1, 2 * n + 1), slice(2 * n + 1, size - 1)
    lower, upper = np.zeros(size), np.full(size, np.inf)
    steep = {NON_NEGATIVE: 1, INVERTIBLE: n + 1, SLIDING: 0}[guess.rule]
    lower[:steep] = SMALLEST_SLOPE * guess.mean_slope
    lower[radii] = 1e-3 * guess.largest_radius
    lower[slopes] = SMALLEST_MAP_SLOPE
    lower[-1] = -np.inf
    upper[radii] = guess.largest_radius
    if guess.fixed_radii:
        lower[radii] = upper[radii] = guess.r
    return lower, upper


def half_swings(operator: Operator, u: Array) -> Array:
    """Give half the swings of the signal the plays of a model are driven by.

    Parameters
    ----------
    operator
        A model with plays.
    u
        Its input.

    Returns
    -------
    numpy.ndarray
        In the units of the plays' input.
    """
    signal = u
    for leaf in leaves_of(operator):
        if isinstance(leaf, TwoEnvelopePrandtlIshlinskii):
            turns = signal[reversals(signal)]
            up, down = leaf.rising(turns), leaf.falling(turns)
            swings = np.where(np.diff(turns) > 0.0, up[1:] - down[:-1], up[:-1] - down[1:])
            return np.abs(swings) / 2.0
        if isinstance(leaf, PrandtlIshlinskii | MaxwellSlip):
            break
        signal = leaf(signal)
    return np.abs(np.diff(signal[reversals(signal)])) / 2.0


def slopes_to_weights(knots: Array) -> tuple[Array, Array]:
    """Give weights at the knots from the slopes beyond them, outwards from slope 1 around 0.

    Parameters
    ----------
    knots
        Shape (k,), none of them 0.

    Returns
    -------
    numpy.ndarray
        Shape (k, k), the weights' derivative by the slopes.
    numpy.ndarray
        Shape (k,), the weights for slopes of 0.
    """
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

"""Plays, their squares and their products with the drive: for a hysteresis that plays do not span.

Sums of plays are odd about their middle and have congruent loops. A butterfly is even, and a curve
before or behind plays makes loops of many shapes. Squares and products make up for both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import shortened
from hyst.identification.families.hammerstein.start.at_full_rate import Dynamic
from hyst.identification.families.hammerstein.start.dense_plays import behind_dynamics
from hyst.identification.families.hammerstein.start.grid_front import OnGrid, refined_on_grid
from hyst.identification.families.hammerstein.start.order_search import NO_PLAYS, Search
from hyst.identification.families.hammerstein.start.output_error import solve_scaled
from hyst.identification.families.hammerstein.start.play_inputs import pieces_of
from hyst.identification.families.hammerstein.start.settled_dynamics import driven_by
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

_WIDEST = 0.9  # of half the range of the drive
_FEW, _MANY = 5, 16
_MOST_SAMPLES = 20_000
_RIDGE = 1e-8  # of the scaled normal matrix: neighbouring plays are nearly alike
_ITERATIONS = 8


@dataclass(frozen=True, eq=False)
class BentPlays:
    """A weighted sum of the drive, plays, their squares and products, and of a constant.

    Parameters
    ----------
    radii
        Shape (n,), input units.
    middle, half_range
        Of the drive, input units: squares are those of what is counted from the middle.
    weights
        Shape (3 n + 2,), output units.
    offset
        Output units.
    """

    radii: Array
    middle: float
    half_range: float
    weights: Array
    offset: float

    def __call__(self, u: Array) -> Array:
        """Give the sum of a drive from rest."""
        shapes = bent_columns(u, self.radii, self.middle, self.half_range)
        return np.asarray(shapes @ self.weights + self.offset)


def bent_columns(u: Array, radii: Array, middle: float, half_range: float) -> Array:
    """Give the drive and plays, squares and products, such that every other one is of all kinds.

    Parameters
    ----------
    u
        Shape (samples,).
    radii
        Shape (n,), input units.
    middle, half_range
        Of the drive, input units.

    Returns
    -------
    numpy.ndarray
        Shape (samples, 3 n + 2), pure numbers; the drive first.
    """
    plays = np.empty((u.size, radii.size))
    _engine.play_outputs(radii.tolist(), np.zeros(radii.size), np.ascontiguousarray(u), plays)
    drive, plays = ((each - middle) / half_range for each in (u[:, None], plays))
    kinds = [
        np.column_stack([plays[:, k], plays[:, k] ** 2, drive[:, 0] * plays[:, k]])
        for k in range(radii.size)
    ]
    some = np.hstack([drive, drive**2, *kinds[::2]])
    others = np.hstack([drive[:, :0], *kinds[1::2]])
    count = min(some.shape[1] - 1, others.shape[1])
    mixed = np.stack([some[:, :count], others[:, :count]], axis=2).reshape(u.size, 2 * count)
    return np.hstack([mixed, some[:, count:], others[:, count:]])


@dataclass(frozen=True, eq=False)
class BentSearch:
    """Dynamics of an order behind few such columns, refined behind many.

    Parameters
    ----------
    data
        The records.
    behind
        The search behind few columns.
    """

    data: Data
    behind: Search

    @classmethod
    def of(cls, data: Data, delay: int | None) -> BentSearch:
        """Cut the records to pieces.

        Parameters
        ----------
        data
            The records.
        delay
            Samples, where it is known.
        """
        middle, half = _range_of(data)
        radii = half * np.geomspace(0.05, _WIDEST, _FEW)
        full = pieces_of(data, lambda u: bent_columns(u, radii, middle, half))
        return cls(data, Search.over(data, delay, full, NO_PLAYS))

    def refined(self, order: int) -> OnGrid | None:
        """Give the best dynamics of an order after refinement behind many columns.

        Parameters
        ----------
        order
            Number of poles.
        """
        found = self.behind.candidates(order)
        if not found:
            return None
        driven = driven_by(self.data, bent_plays(self.data, found[0].dynamics))
        start = Dynamic(found[0].dynamics, np.ones(1), np.inf)
        return refined_on_grid(driven, NO_PLAYS, start, True, _ITERATIONS)


def bent_plays(data: Data, dynamics: LinearDynamics) -> BentPlays:
    """Give the hysteresis before known dynamics as plays, squares and products.

    Parameters
    ----------
    data
        The records.
    dynamics
        Behind the hysteresis.
    """
    middle, half = _range_of(data)
    used = shortened(data, _MOST_SAMPLES // len(data.records))
    radii = half * np.linspace(0.0, _WIDEST, _MANY + 1)[1:]
    shapes = [
        bent_columns(r.u[: w.stop], radii, middle, half)
        for r, w in zip(used.records, used.windows(), strict=True)
    ]
    columns, target = behind_dynamics(used, shapes, dynamics)
    weights = solve_scaled(columns.T @ columns, columns.T @ target, _RIDGE)
    weights = np.zeros(columns.shape[1]) if weights is None else weights
    made = BentPlays(radii, middle, half, weights, 0.0)
    return BentPlays(radii, middle, half, weights, _offset(used, made, dynamics))


def _offset(data: Data, made: BentPlays, dynamics: LinearDynamics) -> float:
    level = float(data.measured().mean()) / dynamics.dc_gain()
    return level - float(np.mean([made(each.u).mean() for each in data.records]))


def _range_of(data: Data) -> tuple[float, float]:
    ends: Sequence[float] = [f(each.u) for each in data.records for f in (np.min, np.max)]
    return (max(ends) + min(ends)) / 2.0, (max(ends) - min(ends)) / 2.0

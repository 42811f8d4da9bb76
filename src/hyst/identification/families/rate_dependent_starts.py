"""First guesses of rate-dependent plays: a grid over radii and widening, weights by least squares.

The weights for given radii and widening solve a non-negative linear least squares problem, so the
grid is over those two alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Start
from hyst.identification.families.rate_dependent_layout import (
    ENVELOPE,
    EVEN,
    NO_MAP,
    RateDependentLayout,
)
from hyst.identification.families.rate_law import RateLaw, bends_to_try, first_constants
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.fit.problem import model_jacobian
from hyst.identification.record_use.overview import Overview
from hyst.models import RateDependentPrandtlIshlinskii

Array = NDArray[np.float64]

_SPANS = (0.3, 0.5, 0.7, 0.9)
"""Largest radius of first guesses, over the largest the records can show."""

_WIDENINGS = (0.0, 0.1, 0.25, 0.5, 0.9)
"""Widening at the fastest sample of first guesses, over the largest radius."""


@dataclass(frozen=True, eq=False)
class _Guess:
    """Residual norm, weights with p0 first, radii, law with its constants, and offset."""

    miss: float
    weights: Array
    radii: Array
    law: RateLaw
    constants: Array
    offset: float


@dataclass(frozen=True, eq=False)
class FirstGuesses:
    """Where fits of rate-dependent plays start.

    Parameters
    ----------
    overview
        The records.
    spacing
        As of ``RateDependentLayout``.
    radii
        Those to keep, or None.
    map_is, knots
        The map, and the number or the places of its knots.
    has_rate
        Whether the records show any rate.
    root
        Square root of every sample's weight, or None.
    """

    overview: Overview
    spacing: str
    radii: tuple[float, ...] | None
    map_is: str
    knots: int | tuple[float, ...]
    has_rate: bool
    root: Array | None

    def best(self, size: int, laws: Sequence[RateLaw], most: int) -> list[Start]:
        """Give the best of a grid.

        Parameters
        ----------
        size
            Number of plays.
        laws
            To try.
        most
            How many to give.
        """
        guesses = [
            self._guess(radii, law, share, bend)
            for law in laws
            for radii in self._radius_guesses(size)
            for share in (_WIDENINGS if self.has_rate else (0.0,))
            for bend in (bends_to_try(law) if share > 0.0 else bends_to_try(law)[:1])
        ]
        guesses.sort(key=lambda each: each.miss)
        return [self._start_from(each) for each in guesses[:most]]

    def _radius_guesses(self, size: int) -> list[Array]:
        if self.radii is not None:
            return [np.array(self.radii)]
        largest = self.overview.data.largest_radius
        even = [share * largest * np.arange(1, size + 1) / size for share in _SPANS]
        if self.spacing == EVEN:
            return even
        return even + [each**2 / each[-1] for each in even if size > 1]

    def _guess(self, radii: Array, law: RateLaw, share: float, bend: float) -> _Guess:
        """Fit the weights for given radii and widening at the fastest sample."""
        overview, n = self.overview, radii.size
        data = overview.data
        constants = first_constants(law, share * data.largest_radius, bend)
        law = law.renewed(constants) if law.renewed is not None else law
        root = np.ones(data.measured().size) if self.root is None else self.root
        curve, dt = law.at(constants), data.records[0].dt
        bank = RateDependentPrandtlIshlinskii(np.zeros(n), radii, curve, dt)
        # The derivative by p0 and p is the input and the play outputs.
        columns = overview.sign * model_jacobian(data, bank)[:, : n + 1] * root[:, None]
        matrix = np.column_stack([columns, root, -root])
        weights, miss = non_negative(matrix, root * data.measured())
        # A weight that starts on its bound would give its radius no derivative.
        slopes = np.maximum(weights[: n + 1], 0.01 * overview.mean_slope)
        return _Guess(miss, slopes, radii, law, constants, float(weights[-2] - weights[-1]))

    def _start_from(self, guess: _Guess) -> Start:
        layout = RateDependentLayout(
            guess.radii,
            self.spacing,
            guess.law,
            self.map_is,
            self._knots_over(guess.offset),
            self.has_rate,
        )
        theta = layout.theta(guess.weights, guess.radii, guess.constants, guess.offset)
        return layout.parametrization(self.overview), theta

    def _knots_over(self, offset: float) -> Array:
        """Spread the knots evenly over the signal that the map acts on, none at 0."""
        data = self.overview.data
        if self.map_is == NO_MAP:
            return np.empty(0)
        if not isinstance(self.knots, int):
            places = np.array(self.knots)
            return np.asarray(places[np.abs(places) > 2e-6 * data.half_range])
        if self.map_is == ENVELOPE:
            low = min(float(each.u.min()) for each in data.records)
            high = max(float(each.u.max()) for each in data.records)
        else:
            signal = self.overview.sign * (data.measured() - offset)
            low, high = float(signal.min()), float(signal.max())
        knots = np.linspace(low, high, self.knots + 2)[1:-1]
        return np.asarray(knots[np.abs(knots) > 1e-6 * (high - low)])

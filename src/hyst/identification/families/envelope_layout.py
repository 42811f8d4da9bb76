"""Where the slopes of two envelopes stand in theta, and how they keep room for the plays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.play_layout import (
    SMALLEST_MAP_SLOPE,
    FirstGuess,
    PlayLayout,
    PlayParametrization,
    bounds_of,
    slopes_to_weights,
)
from hyst.identification.fit.weight_rules import NON_NEGATIVE, basis
from hyst.operators import Operator

Array = NDArray[np.float64]

NEXT_TO_ZERO = 1e-3
"""Of the input range: an end of the input closer to 0 than that counts as that far from it."""


@final
@dataclass(frozen=True, eq=False)
class EnvelopeLayout:
    """Knots of two envelopes, and their slopes: of rising beyond each knot, of falling by pieces.

    Parameters
    ----------
    knots
        Shape (k,), of both envelopes, ascending, none 0.
    ends
        Shape (k + 2,), the same and the ends of the input, ascending, none 0: where falling bends.
    """

    knots: Array
    ends: Array

    @classmethod
    def over(cls, knots: Array, input_range: tuple[float, float]) -> EnvelopeLayout:
        """Give the layout of knots over the range of an input.

        Parameters
        ----------
        knots
            Shape (k,), none 0.
        input_range
            Smallest and largest input.
        """
        low, high = input_range
        least = NEXT_TO_ZERO * (high - low)
        # A range that ends next to 0 gets its end on this side of it, where falling can bend.
        low = max(low, least) if low > -least else low
        high = min(high, -least) if high < least else high
        inner = np.sort(knots)
        return cls(inner, np.concatenate([[low], inner[(inner > low) & (inner < high)], [high]]))

    @property
    def pieces(self) -> int:
        """Number of slopes of falling."""
        return int(self.ends.size - 1)

    def same(self, slopes: Array) -> Array:
        """Give the slopes of falling that make it the same as rising.

        Parameters
        ----------
        slopes
            Of rising, beyond each knot.
        """
        transform, fixed = self._rising_over(0.5 * (self.ends[1:] + self.ends[:-1]))
        return np.asarray(transform @ slopes + fixed)

    def of_pieces(self, slopes: Array) -> tuple[Array, float]:
        """Give the slopes of rising beyond each knot, and that around 0, of slopes by pieces.

        Parameters
        ----------
        slopes
            Shape (pieces,).
        """
        transform, fixed = self._rising_over(0.5 * (self.ends[1:] + self.ends[:-1]))
        around = slopes[fixed > 0.0]
        unit = float(around.mean()) if around.size else 1.0
        seen = transform.any(axis=0)
        return np.where(seen, transform.T @ slopes, unit), unit

    def parametrize(
        self, template: Operator, guess: FirstGuess
    ) -> tuple[PlayParametrization, Array]:
        """Lay out theta over the constants of a model between two envelopes, gain and offset.

        Parameters
        ----------
        template
            The operator of the first guess.
        guess
            The first guess.
        """
        n, k, m = guess.p.size, self.knots.size, self.pieces
        fixed = template.parameters().values.copy()
        size = 2 * n + 2 + k + m
        transform = np.zeros((fixed.size, size))
        rising, falling = slice(2 * n + 1, 2 * n + 1 + k), slice(2 * n + 1 + k, size - 1)
        transform[1 : 1 + k, rising], fixed[1 : 1 + k] = slopes_to_weights(guess.knots)
        at = 2 * (k + 1)
        own, constant, by_rising = self._falling_weights()
        places = slice(at, at + own.shape[0])
        transform[places, falling], transform[places, rising] = own, by_rising
        fixed[places] = constant
        at += 2 * own.shape[0]
        weights_of = basis(NON_NEGATIVE, n)
        transform[at : at + n + 1, : n + 1] = weights_of
        transform[at + n + 1 : at + 2 * n + 1, n + 1 : 2 * n + 1] = np.eye(n)
        fixed[at : at + 2 * n + 1] = 0.0
        transform[-1, -1], fixed[-1] = 1.0, 0.0
        free = np.linalg.solve(weights_of, np.concatenate([[guess.p0], guess.p]))
        theta = np.concatenate([free, guess.r, np.ones(k + m), [guess.offset]])
        lower, upper = bounds_of(guess, size)
        if not guess.fixed_radii:
            # In units of an envelope whose slope around 0 may be the smallest of all.
            upper[n + 1 : 2 * n + 1] /= SMALLEST_MAP_SLOPE
        plays = PlayLayout(weights_of, lower, upper)
        canonical = partial(self._canonical, plays, n)
        return PlayParametrization(
            template, transform, fixed, lower, upper, canonical, layout=plays
        ), theta

    def _canonical(self, plays: PlayLayout, n: int, theta: Array) -> Array:
        return self.with_room(plays.canonical(theta), n)

    def with_room(self, theta: Array, n: int) -> Array:
        """Give theta with falling nowhere more than 2 r_1 below rising, its slopes changed.

        From 0 outwards each slope of falling is made as steep (to the right) or as flat (to the
        left) as it must be; that leaves every slope at least as large as the smaller of the two.

        Parameters
        ----------
        theta
            With sorted plays.
        n
            Number of plays.
        """
        if n == 0:
            return theta
        k = self.knots.size
        room = 2.0 * float(theta[n + 1 : 2 * n + 1].min())
        rising = self.same(theta[2 * n + 1 : 2 * n + 1 + k])
        changed = theta.copy()
        slopes = changed[2 * n + 1 + k : -1]
        width = np.diff(self.ends)
        zero = int(np.searchsorted(self.ends, 0.0)) - 1  # the piece that holds 0, or one beside
        gap_right = gap_left = 0.0
        if 0 <= zero < self.pieces:
            most, least = room / -self.ends[zero], room / self.ends[zero + 1]
            slopes[zero] = np.clip(slopes[zero], rising[zero] - least, rising[zero] + most)
            gap_right = (slopes[zero] - rising[zero]) * self.ends[zero + 1]
            gap_left = (slopes[zero] - rising[zero]) * self.ends[zero]
        for j in range(max(zero + 1, 0), self.pieces):
            slopes[j] = max(slopes[j], rising[j] - (room + gap_right) / width[j])
            gap_right += (slopes[j] - rising[j]) * width[j]
        for j in range(min(zero, self.pieces) - 1, -1, -1):
            slopes[j] = min(slopes[j], rising[j] + (room + gap_left) / width[j])
            gap_left -= (slopes[j] - rising[j]) * width[j]
        return changed

    def _rising_over(self, places: Array) -> tuple[Array, Array]:
        """Slopes of rising at places that are no knots, by its slopes beyond each knot."""
        transform = np.zeros((places.size, self.knots.size))
        fixed = np.zeros(places.size)
        for i, place in enumerate(places):
            between = (self.knots * place > 0.0) & (np.abs(self.knots) <= abs(place))
            if between.any():
                chosen = np.flatnonzero(between)
                transform[i, chosen[np.argmax(np.abs(self.knots[chosen]))]] = 1.0
            else:
                fixed[i] = 1.0
        return transform, fixed

    def _falling_weights(self) -> tuple[Array, Array, Array]:
        """Weights of falling by its slopes, what they are for slopes of 0, and by those of rising.

        Beyond the ends its slope is that of rising.
        """
        ends, m = self.ends, self.pieces
        reach = ends[-1] - ends[0]
        beyond, fixed = self._rising_over(np.array([ends[0] - reach, ends[-1] + reach]))
        if ends[0] > 0.0:  # what is left of the input holds 0, and rising has slope 1 there
            beyond[0], fixed[0] = 0.0, 1.0
        if ends[-1] < 0.0:
            beyond[1], fixed[1] = 0.0, 1.0
        # Slopes of all m + 2 pieces: by falling, constant, by rising.
        own = np.vstack([np.zeros(m), np.eye(m), np.zeros(m)])
        constant = np.concatenate([fixed[:1], np.zeros(m), fixed[1:]])
        by_rising = np.vstack([beyond[:1], np.zeros((m, self.knots.size)), beyond[1:]])
        zero = int(np.searchsorted(ends, 0.0))
        differences = np.zeros((ends.size + 1, m + 2))
        differences[0, zero] = 1.0
        for i, end in enumerate(ends):
            outer, inner = (i + 1, i) if end > 0.0 else (i, i + 1)
            differences[1 + i, outer], differences[1 + i, inner] = 1.0, -1.0
        return differences @ own, differences @ constant, differences @ by_rising

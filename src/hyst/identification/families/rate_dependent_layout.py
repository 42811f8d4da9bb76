"""Free parameters of rate-dependent plays, with a map before or after them or none.

theta = (p_0 .. p_n, spacing or radii or nothing, constants of the law, slopes of the map, offset).
The slopes of a map are those of its pieces, counted outwards from slope 1 around 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.play_layout import SMALLEST_MAP_SLOPE, slopes_to_weights
from hyst.identification.families.rate_law import RateLaw
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization, unchanged
from hyst.identification.record_use.overview import Overview
from hyst.models import RateCurve, RateDependentPrandtlIshlinskii
from hyst.operators import Affine, Composition, DeadZone, Operator

Array = NDArray[np.float64]

EVEN, FREE, GIVEN = "even", "free", "given"
NO_MAP, DEAD_ZONE, ENVELOPE = "none", "dead-zone", "envelope"


@dataclass(frozen=True, eq=False)
class RateDependentLayout:
    """What of rate-dependent plays is free.

    Parameters
    ----------
    radii
        Shape (n,): those to keep where the spacing is ``given``; else only their number counts.
    spacing
        ``"even"``, ``"free"`` or ``"given"``.
    law
        Of the widening.
    map_is
        ``"none"``; ``"dead-zone"``: after the plays; ``"envelope"``: before them.
    knots
        Shape (q,), of the map, none 0; empty without one.
    has_rate
        Whether the records show any rate; else nothing widens.
    """

    radii: Array
    spacing: str
    law: RateLaw
    map_is: str
    knots: Array
    has_rate: bool

    @property
    def plays(self) -> int:
        """Number of plays n."""
        return int(self.radii.size)

    @property
    def radius_count(self) -> int:
        """How many parameters say where the radii are."""
        return radius_count(self.spacing, self.plays)

    @property
    def law_places(self) -> slice:
        """Where the constants of the law stand in theta."""
        first = self.plays + 1 + self.radius_count
        return slice(first, first + self.law.size)

    @property
    def size(self) -> int:
        """Entries of theta."""
        return int(self.law_places.stop) + int(self.knots.size) + 1

    def theta(self, weights: Array, radii: Array, constants: Array, offset: float) -> Array:
        """Put theta together, with a map that is the identity.

        Parameters
        ----------
        weights
            Shape (n + 1,), p0 first.
        radii
            Shape (n,).
        constants
            Of the law.
        offset
            Of the output.
        """
        places, slopes = radii[: self.radius_count], np.ones(self.knots.size)
        return np.concatenate([weights, places, constants, slopes, [offset]])

    def parametrization(self, overview: Overview) -> RatedParametrization:
        """Lay theta out over the constants of the operator.

        Parameters
        ----------
        overview
            The records, for sign, bounds and sample time.
        """
        n, law = self.plays, self.law
        plays = RateDependentPrandtlIshlinskii(
            np.zeros(n),
            self.radii if self.spacing == GIVEN else np.arange(1.0, n + 1.0),
            law.curve,
            overview.data.records[0].dt,
            overview.mean_slope,
        )
        stages = self._with_map(plays)
        template = Composition((*stages, Affine(overview.sign, 0.0)))
        fixed = template.parameters().values.copy()
        transform = np.zeros((fixed.size, self.size))
        at = 2 * (self.knots.size + 1) if self.map_is == ENVELOPE else 0
        self._lay_plays(transform, fixed, at)
        if self.map_is != NO_MAP:
            end = at + len(plays.parameters())
            self._lay_map(transform, fixed, 0 if self.map_is == ENVELOPE else end)
        transform[-1, -1], fixed[-1] = 1.0, 0.0
        return RatedParametrization(
            template,
            transform,
            fixed,
            *self._bounds(overview),
            partial(_with_sorted_plays, n) if self.spacing == FREE else unchanged,
            layout=self,
        )

    def _with_map(self, plays: Operator) -> tuple[Operator, ...]:
        if self.map_is == NO_MAP:
            return (plays,)
        weights = np.concatenate([[1.0], np.zeros(self.knots.size)])
        identity = DeadZone(weights, np.concatenate([[0.0], self.knots]))
        return (identity, plays) if self.map_is == ENVELOPE else (plays, identity)

    def _lay_plays(self, transform: Array, fixed: Array, at: int) -> None:
        n, m, law = self.plays, self.radius_count, self.law
        transform[at : at + n + 1, : n + 1] = np.eye(n + 1)
        fixed[at : at + n + 1] = 0.0
        radii = slice(at + n + 1, at + 2 * n + 1)
        if self.spacing != GIVEN:
            spread = np.arange(1.0, n + 1.0)[:, None] if self.spacing == EVEN else np.eye(n)
            transform[radii, n + 1 : n + 1 + m], fixed[radii] = spread[:, :m], 0.0
        curve = slice(radii.stop, radii.stop + law.fixed.size)
        transform[curve, self.law_places], fixed[curve] = law.transform, law.fixed

    def _lay_map(self, transform: Array, fixed: Array, at: int) -> None:
        weights = slice(at + 1, at + 1 + self.knots.size)
        by_slopes, constant = slopes_to_weights(self.knots)
        transform[weights, self.law_places.stop : -1], fixed[weights] = by_slopes, constant

    def _bounds(self, overview: Overview) -> tuple[Array, Array]:
        n, m, largest = self.plays, self.radius_count, overview.data.largest_radius
        if self.map_is == ENVELOPE:
            # In units of an envelope whose slope around 0 may be the smallest of all.
            largest /= SMALLEST_MAP_SLOPE
        lower, upper = np.zeros(self.size), np.full(self.size, np.inf)
        lower[0] = SMALLEST_SLOPE * overview.mean_slope
        lower[n + 1 : n + 1 + m] = 1e-3 * overview.data.largest_radius
        upper[n + 1 : n + 1 + m] = largest / n if self.spacing == EVEN else largest
        lower[self.law_places], upper[self.law_places] = self.law.lower, self.law.upper
        if not self.has_rate:
            upper[self.law_places] = 0.0
        lower[self.law_places.stop : -1] = SMALLEST_MAP_SLOPE
        lower[-1] = -np.inf
        return lower, upper

    def with_law(self, law: RateLaw) -> RateDependentLayout:
        """Give the layout with another law."""
        return replace(self, law=law)


@dataclass(frozen=True, eq=False)
class RatedParametrization(Parametrization):
    """A parametrization that knows its layout.

    Parameters
    ----------
    layout
        What of the plays is free, in the units of the fit.
    """

    layout: RateDependentLayout = None  # type: ignore[assignment]  # fields before have defaults

    def in_units(self, theta: Array, input_scale: float, output_scale: float) -> Self:
        """Give the same free parameters for signals that are larger by these factors."""
        scaled = super().in_units(theta, input_scale, output_scale)
        law = self.layout.law
        curve = RateCurve(0.0, (), np.zeros(law.curve.knees.size), law.curve.knees * input_scale)
        law = replace(law, fastest=law.fastest * input_scale, curve=curve)
        of_knots = output_scale if self.layout.map_is == DEAD_ZONE else input_scale
        layout = replace(
            self.layout,
            law=law,
            knots=self.layout.knots * of_knots,
            radii=self.layout.radii * input_scale,
        )
        return replace(scaled, layout=layout)


def radius_count(spacing: str, plays: int) -> int:
    """Give how many parameters say where the radii are.

    Parameters
    ----------
    spacing
        ``"even"``, ``"free"`` or ``"given"``.
    plays
        Number of plays.
    """
    return {EVEN: min(plays, 1), FREE: plays, GIVEN: 0}[spacing]


def _with_sorted_plays(n: int, theta: Array) -> Array:
    """Sort the plays by radius, each with its weight: their order means nothing."""
    order = np.argsort(theta[n + 1 : 2 * n + 1], kind="stable")
    result = theta.copy()
    result[1 : n + 1] = theta[1 : n + 1][order]
    result[n + 1 : 2 * n + 1] = theta[n + 1 : 2 * n + 1][order]
    return result

"""Prandtl-Ishlinskii models with a map: plays behind an envelope, or in front of an output map.

Scales that only shift a factor from one stage to the next are fixed: the slope of a map around 0
is 1. Slopes of maps are bounded from below, so every iterate is invertible; but for an envelope of
any shape, which has no inverse.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.checks.numbers import whole_number as as_whole_number
from hyst.errors import InputError
from hyst.identification.families.family import Fit, Start, Words
from hyst.identification.families.free_envelope import free_envelope_starts, with_plays_left_out
from hyst.identification.families.option import (
    Option,
    as_numbers,
    choice,
    option,
    read_numbers,
)
from hyst.identification.families.play_layout import (
    FirstGuess,
    PlayParametrization,
    parametrize_plays,
)
from hyst.identification.families.plays import PLAY_TEXT, Plays
from hyst.identification.families.prandtl_ishlinskii import PLAYS
from hyst.identification.fit.weight_rules import INVERTIBLE
from hyst.identification.fit.weights import Weights
from hyst.identification.record_use.overview import Overview
from hyst.operators import Affine

Array = NDArray[np.float64]

MOST_KNOTS = 50
MONOTONE, FREE = "monotone", "free"

_SLOPES_TEXT = (
    "In the table below this map is called dead_zone: each of its weights is the change of slope "
    "at a threshold; the thresholds are in the model file."
)


def _as_knots(knots: Any, name: str) -> int | tuple[float, ...]:
    """Check a number of knots, or the places where they are."""
    if isinstance(knots, int | float | str | np.generic):
        return as_whole_number(knots, name, 1, MOST_KNOTS, ", or a list of their places")
    what = f"a number from 1 to {MOST_KNOTS}, or a list of at most as many finite places"
    places = np.unique(as_numbers(knots, name, what))
    if places.size > MOST_KNOTS:
        raise InputError(f"{name} are {places.size} places; give {what}")
    return tuple(places.tolist())


def _read_knots(text: str, name: str) -> Any:
    if "," in text:
        return read_numbers(text, name)
    return int(text) if text.isdecimal() else text


KNOTS_OPTION = Option(
    _as_knots,
    "Knots of the map; of an envelope of any shape also their places, as -5,4.",
    _read_knots,
    "N|K1,K2,..",
)
ENVELOPE_OPTION = choice(
    (MONOTONE, FREE), "Envelope monotone, or free: of any shape, without an inverse."
)


@dataclass(frozen=True)
class MappedPlays(Plays):
    """Plays and a piecewise linear map.

    Parameters
    ----------
    plays, radii, weights
        See ``Plays``.
    knots
        Number of knots of the map, 1 to 50, evenly spaced over the signal it acts on.
    """

    knots: Any = option(6, KNOTS_OPTION)

    def least_parameters(self, size: int) -> int:
        """Give the number of weights, radii, slopes and the offset."""
        return 2 * size + 2 + self._knot_count

    @property
    def _knot_count(self) -> int:
        return self.knots if isinstance(self.knots, int) else len(self.knots)

    def knots_over(self, overview: Overview, weights: Weights) -> Array:
        """Spread the knots evenly, none at 0."""
        low, high = self.range_of_map(overview, weights)
        knots = np.linspace(low, high, self.knots + 2)[1:-1]
        return np.asarray(knots[np.abs(knots) > 1e-6 * (high - low)])

    @abstractmethod
    def range_of_map(self, overview: Overview, weights: Weights) -> tuple[float, float]:
        """Give the range of the signal the map acts on.

        Parameters
        ----------
        overview
            The records.
        weights
            Plays of the first guess.
        """


@final
@dataclass(frozen=True)
class GeneralizedPrandtlIshlinskii(MappedPlays):
    """``y = sign P[gamma(u)] + offset`` with an envelope gamma before the plays (S1 sec. 2.1).

    Parameters
    ----------
    plays, radii, weights
        Number of plays or ``"auto"``, radii to keep, and what weights may be: see ``Plays``.
    knots
        Number of knots of the envelope, 1 to 50, evenly spaced over the input; or their places,
        input units.
    envelope
        ``"monotone"``, so that there is an inverse; or ``"free"``: it may be flat and fall, and a
        number of knots means that their places are found, too.
    """

    name = "gpi"
    words = Words(
        full_name="generalized Prandtl-Ishlinskii model",
        equations=("y(t) = {sign}P[\u03b3(u)](t) + offset", PLAYS),
        explanations=(
            PLAY_TEXT,
            "\u03b3 is a piecewise linear map of the input before the plays; it bends the loop "
            "over the input, so that it may be asymmetric and saturate.",
            _SLOPES_TEXT,
        ),
    )
    compared = True

    envelope: Any = option(MONOTONE, ENVELOPE_OPTION)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.envelope == FREE and self.weights == INVERTIBLE:
            raise InputError(
                f"weights is {INVERTIBLE!r} but a free envelope has no inverse; leave out weights"
            )

    def rules(self) -> tuple[str, ...]:
        """Give what the weights may be; behind a free envelope they are never negative."""
        return super().rules() if self.envelope == MONOTONE else ()

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with scaled radii and knots."""
        scaled = super().in_units(input_scale, output_scale)
        if isinstance(self.knots, int):
            return scaled
        return replace(scaled, knots=[each * input_scale for each in self.knots])

    def least_parameters(self, size: int) -> int:
        """Give the number of weights, radii, slopes, the offset, and knots that are found."""
        moving = self.envelope == FREE and isinstance(self.knots, int)
        return super().least_parameters(size) + (self._knot_count if moving else 0)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Start as all plays do, or from an envelope of any shape."""
        if self.envelope == MONOTONE:
            return super().starts(overview, size, most)
        return free_envelope_starts(overview, size, most, self.knots, self.radii)

    def _refit(
        self, fit: Fit, overview: Overview, working: NDArray[np.bool_], max_iterations: int
    ) -> Fit:
        if self.envelope == MONOTONE:
            return super()._refit(fit, overview, working, max_iterations)
        parametrization, theta = with_plays_left_out(fit, working)
        fit = replace(fit, parametrization=parametrization)
        solution = self.solve(fit.problem(overview.data, overview.kept), theta, max_iterations)
        return replace(fit, solution=solution)

    def knots_over(self, overview: Overview, weights: Weights) -> Array:
        """Give the places of the knots, or spread them evenly; none at 0."""
        if isinstance(self.knots, int):
            return super().knots_over(overview, weights)
        low, high = self.range_of_map(overview, weights)
        places = np.array(self.knots)
        return np.asarray(places[np.abs(places) > 1e-6 * (high - low)])

    def parametrize(self, guess: FirstGuess) -> tuple[PlayParametrization, Array]:
        """Give weights, radii, slopes of the envelope and offset."""
        model = models.GeneralizedPrandtlIshlinskii(guess.map, guess.plays)
        return parametrize_plays(Affine(guess.sign, guess.offset) @ model, guess, map_at=0)

    def range_of_map(self, overview: Overview, weights: Weights) -> tuple[float, float]:
        """Give the range of the whole input."""
        records = overview.data.records
        return min(float(r.u.min()) for r in records), max(float(r.u.max()) for r in records)


@final
@dataclass(frozen=True)
class ModifiedPrandtlIshlinskii(MappedPlays):
    """``y = sign Lambda(P[u]) + offset`` with a map Lambda after the plays (S4 sec. III-D).

    Parameters
    ----------
    plays, radii, weights
        Number of plays or ``"auto"``, radii to keep, and what weights may be: see ``Plays``.
    knots
        Number of knots of the map, evenly spaced over the signal it acts on.
    """

    name = "mpi"
    words = Words(
        full_name="modified Prandtl-Ishlinskii model",
        equations=("y(t) = {sign}\u039b(P[u](t)) + offset", PLAYS),
        explanations=(
            PLAY_TEXT,
            "\u039b is a piecewise linear map after the plays; it bends the loop over the output, "
            "so that it may be asymmetric.",
            _SLOPES_TEXT,
        ),
    )
    compared = True

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.knots, int):
            raise InputError(
                f"knots are {list(self.knots)}; give their number, for places of knots behind the "
                "plays follow from the output"
            )

    def parametrize(self, guess: FirstGuess) -> tuple[PlayParametrization, Array]:
        """Give weights, radii, slopes of the output map and offset."""
        model = models.ModifiedPrandtlIshlinskii(guess.plays, guess.map)
        template = Affine(guess.sign, guess.offset) @ model
        return parametrize_plays(template, guess, map_at=1 + 2 * guess.p.size)

    def range_of_map(self, overview: Overview, weights: Weights) -> tuple[float, float]:
        """Give the range of the output without sign and offset."""
        signal = overview.sign * (overview.data.measured() - weights.offset)
        return float(signal.min()), float(signal.max())

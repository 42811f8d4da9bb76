"""Prandtl-Ishlinskii models: plays alone, behind an envelope, or in front of an output map."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.identification.families.family import Words
from hyst.identification.families.option import option, whole_number
from hyst.identification.families.play_layout import (
    FirstGuess,
    PlayParametrization,
    parametrize_plays,
)
from hyst.identification.families.plays import PLAY_TEXT, Plays
from hyst.identification.fit.weights import Weights
from hyst.identification.record_use.overview import Overview
from hyst.operators import Affine

Array = NDArray[np.float64]

MOST_KNOTS = 50

PLAYS = "P[w](t) = p0 w(t) + \u03a3 p\u1d62 F\u1d63\u1d62[w](t)"
_SLOPES_TEXT = (
    "In the table below this map is called dead_zone: each of its weights is the change of slope "
    "at a threshold; the thresholds are in the model file."
)


@final
@dataclass(frozen=True)
class PrandtlIshlinskii(Plays):
    """``y = sign (p0 u + sum_i p_i z_i) + offset``.

    Parameters
    ----------
    plays, radii, weights
        Number of plays or ``"auto"``, radii to keep, and what weights may be: see ``Plays``.
    """

    name = "pi"
    words = Words(
        full_name="Prandtl-Ishlinskii model",
        equations=("y(t) = {sign}P[u](t) + offset", PLAYS),
        explanations=(PLAY_TEXT,),
    )
    compared = True

    def least_parameters(self, size: int) -> int:
        """Give the number of weights, radii and the offset."""
        return 2 * size + 2

    def parametrize(self, guess: FirstGuess) -> tuple[PlayParametrization, Array]:
        """Give weights, radii and offset."""
        template = Affine(guess.sign, guess.offset) @ guess.plays
        return parametrize_plays(template, guess, map_at=None)

    def knots_over(self, overview: Overview, weights: Weights) -> Array:
        """Give none: there is no map."""
        return np.empty(0)


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

    knots: Any = option(6, whole_number(1, MOST_KNOTS, "Knots of the map."))

    @final
    def least_parameters(self, size: int) -> int:
        """Give the number of weights, radii, slopes and the offset."""
        return 2 * size + 2 + int(self.knots)

    @final
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
        Number of knots of the map, evenly spaced over the signal it acts on.
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

    def parametrize(self, guess: FirstGuess) -> tuple[PlayParametrization, Array]:
        """Give weights, radii, slopes of the output map and offset."""
        model = models.ModifiedPrandtlIshlinskii(guess.plays, guess.map)
        template = Affine(guess.sign, guess.offset) @ model
        return parametrize_plays(template, guess, map_at=1 + 2 * guess.p.size)

    def range_of_map(self, overview: Overview, weights: Weights) -> tuple[float, float]:
        """Give the range of the output without sign and offset."""
        signal = overview.sign * (overview.data.measured() - weights.offset)
        return float(signal.min()), float(signal.max())

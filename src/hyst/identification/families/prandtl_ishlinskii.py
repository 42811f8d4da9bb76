"""The Prandtl-Ishlinskii model: plays alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Words
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

PLAYS = "P[w](t) = p0 w(t) + \u03a3 p\u1d62 F\u1d63\u1d62[w](t)"


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

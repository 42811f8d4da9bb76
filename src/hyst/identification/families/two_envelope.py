"""Plays between two envelopes: one for rising and one for falling input.

theta = (p0, p_1 .. p_n, r_1 .. r_n, slopes of rising, slopes of falling, offset). Both envelopes
bend at the same knots; the slope of rising around 0 is 1. The one of falling has a knot more at
either end of the input, beyond which both go on side by side, so that they never cross where no
sample is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.choice.fits_from_starts import best_of_starts
from hyst.identification.families.branch_envelopes import guess_of_branches
from hyst.identification.families.envelope_layout import EnvelopeLayout
from hyst.identification.families.family import Fit, Start, Words
from hyst.identification.families.mapped_plays import (
    GeneralizedPrandtlIshlinskii,
    MappedPlays,
)
from hyst.identification.families.play_layout import FirstGuess, PlayParametrization
from hyst.identification.families.plays import (
    PLAY_TEXT,
    fine_weights,
    layout_of,
    negative_weights_pay,
)
from hyst.identification.fit.bounded_least_squares import Problem, Solution
from hyst.identification.fit.problem import model_output
from hyst.identification.fit.weight_rules import INVERTIBLE, NON_NEGATIVE
from hyst.identification.fit.weights import Weights
from hyst.identification.record_use.overview import Overview
from hyst.operators import Affine, DeadZone

Array = NDArray[np.float64]

_ITERATIONS = 30

MORE_STEPS, COARSER = 3, 30.0
"""Than other families take: on actuators outside the class, valleys of radii, slopes and the gap
between the envelopes are long, and hundreds of steps at their bottom change nothing."""

MUCH_WORSE = 2.0
"""Residual of plays of weights of one sign over that of both signs: beyond, those are missed."""
NOTHING_SAVED = 0.8
"""Residual behind an envelope over that of a line: above, plays of one sign describe nothing."""


@final
@dataclass(frozen=True)
class TwoEnvelope(MappedPlays):
    """``y = sign T[u] + offset``, T plays between an envelope up and another one down.

    Parameters
    ----------
    plays, radii, weights
        Number of plays or ``"auto"``, and radii to keep: see ``Plays``. Weights are non-negative.
    knots
        Number of knots of either envelope, 1 to 50, evenly spaced over the input; or their places,
        input units.
    """

    name = "two-envelope"
    in_reserve = True
    words = Words(
        full_name="Prandtl-Ishlinskii model with two envelopes",
        equations=(
            "y(t) = {sign}T[u](t) + offset",
            "T[u] = p0 (\u03b3\u2191(u) + \u03b3\u2193(u)) / 2 + \u03a3 p[i] z[i]",
            "z[i] = max(\u03b3\u2191(u) - r[i], min(\u03b3\u2193(u) + r[i], z[i]))",
        ),
        explanations=(
            PLAY_TEXT.replace("its input", "its envelope"),
            "\u03b3\u2191 (rising) and \u03b3\u2193 (falling) are piecewise linear maps of the "
            "input; the one pushes the plays up while the input rises, the other one pushes them "
            "down while it falls, so that the loop may be asymmetric, saturate, and be wider at "
            "one end than at the other.",
            "In the table below each weight of rising and falling is the change of slope at a "
            "threshold; the thresholds are in the model file.",
        ),
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.weights == INVERTIBLE:
            raise InputError(
                f"weights is {INVERTIBLE!r} but plays between two envelopes have weights of 0 or "
                "more; leave out weights"
            )

    def rules(self) -> tuple[str, ...]:
        """Give nothing: weights are never negative."""
        return ()

    def rule(self, overview: Overview) -> str:
        """Give what the weights may be."""
        return NON_NEGATIVE

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with scaled radii and knots."""
        scaled = super().in_units(input_scale, output_scale)
        if isinstance(self.knots, int):
            return scaled
        return replace(scaled, knots=[each * input_scale for each in self.knots])

    def least_parameters(self, size: int) -> int:
        """Give the number of weights, radii, slopes of both envelopes and the offset."""
        return super().least_parameters(size) + self._knot_count + 1

    def knots_over(self, overview: Overview, weights: Weights) -> Array:
        """Give the knots of one envelope, as ``gpi`` has them."""
        return self._one_envelope().knots_over(overview, weights)

    def range_of_map(self, overview: Overview, weights: Weights) -> tuple[float, float]:
        """Give the range of the whole input."""
        return self._one_envelope().range_of_map(overview, weights)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Start from plays behind one envelope, which becomes both, and from the two branches."""
        fit = best_of_starts(self._one_envelope(), overview, size, most, _ITERATIONS)
        _require_no_negative_weights(fit, overview)
        layout, theta = layout_of(fit), fit.solution.theta
        guess = self._guess(overview, layout.radii(theta))
        envelopes = EnvelopeLayout.over(guess.knots, guess.input_range)
        parametrization, started = self.parametrize(guess)
        plays = 2 * layout.plays + 1
        started[:plays], started[-1] = theta[:plays], theta[-1]
        started[plays:-1] = np.concatenate([theta[plays:-1], envelopes.same(theta[plays:-1])])
        found = [started]
        apart = guess_of_branches(overview, envelopes, layout.plays)
        if apart is not None and self.radii is None:
            found.append(_with_offset(overview, parametrization, apart))
        bounds = parametrization.lower, parametrization.upper
        return [(parametrization, np.clip(each, *bounds)) for each in found]

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = 1e-3
    ) -> Solution:
        """Minimise the squared error, up to a sixth of the standard errors, and in more steps."""
        return super().solve(problem, theta, MORE_STEPS * max_iterations, COARSER * tolerance)

    def parametrize(self, guess: FirstGuess) -> tuple[PlayParametrization, Array]:
        """Give weights, radii, slopes of both envelopes and offset."""
        layout = EnvelopeLayout.over(guess.knots, guess.input_range)
        falling = DeadZone(
            np.concatenate([[1.0], np.zeros(layout.ends.size)]),
            np.concatenate([[0.0], layout.ends]),
        )
        model = models.TwoEnvelopePrandtlIshlinskii(
            guess.plays.p, guess.plays.r, guess.map, falling, guess.plays.p0
        )
        return layout.parametrize(Affine(guess.sign, guess.offset) @ model, guess)

    def _guess(self, overview: Overview, r: Array) -> FirstGuess:
        guess = super()._guess(overview, r)
        low, high = float(overview.input.min()), float(overview.input.max())
        return replace(guess, input_range=(low, high))

    def _one_envelope(self) -> GeneralizedPrandtlIshlinskii:
        return GeneralizedPrandtlIshlinskii(
            plays=self.plays, radii=self.radii, weights=NON_NEGATIVE, knots=self.knots
        )


def _with_offset(overview: Overview, parametrization: PlayParametrization, theta: Array) -> Array:
    """Give theta with the offset at which the mean error is 0."""
    theta = parametrization.canonical(np.clip(theta, parametrization.lower, parametrization.upper))
    modelled = model_output(overview.data, parametrization.operator(theta))
    theta[-1] += float(np.mean(overview.data.measured() - modelled))
    return theta


def _require_no_negative_weights(fit: Fit, overview: Overview) -> None:
    """Refuse records of which plays of one sign tell nothing, and of both signs a lot."""
    if not negative_weights_pay(overview):
        return
    residual = fit.problem(overview.data, overview.kept).residual(fit.solution.theta)
    rms = float(np.sqrt(np.mean(residual**2)))
    y, u = overview.data.measured(), overview.input
    line = float(np.std(y) * np.sqrt(max(1.0 - np.corrcoef(u, y)[0, 1] ** 2, 0.0)))
    if rms > NOTHING_SAVED * line and rms > MUCH_WORSE * fine_weights(overview, INVERTIBLE).rms:
        raise NotIdentifiableError(
            "the loop flattens after a turn, as friction's do, which needs plays of negative "
            "weight, and between two envelopes there are none; use family 'pi', 'gpi' or "
            "'maxwell-slip'"
        )

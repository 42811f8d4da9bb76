"""Maxwell-slip friction: springs that slide, found as plays whose weights have their signs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.errors import NotIdentifiableError
from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Fit, Start, Words
from hyst.identification.families.play_layout import (
    FirstGuess,
    PlayParametrization,
    parametrize_plays,
)
from hyst.identification.families.plays import PlayBank, fine_weights
from hyst.identification.fit.weight_rules import SLIDING
from hyst.identification.fit.weights import Weights
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]

SLIDES = 0.95
"""Springs that slide must leave less than this share of what a straight line leaves."""
SHORTEST = 0.01
"""Least way to sliding of first guesses, over the largest that the records show."""


@dataclass(frozen=True, eq=False)
class SlidingParametrization(PlayParametrization):
    """Plays that are springs which slide: ``p0 = k0 + sum k``, ``p = -k``.

    Parameters
    ----------
    template, transform, fixed, lower, upper, canonical, gauges, gauge_count, is_allowed, layout
        As of ``PlayParametrization``; the template is the plays, the operator the springs.
    """

    def stiffnesses(self, theta: Array) -> Array:
        """Give k0, k_1 .. k_n, in the units of the template."""
        count = self.layout.plays + 1
        return np.asarray(self.transform[0, :count] * theta[:count])

    def ways(self, theta: Array) -> Array:
        """Give the ways to sliding r_1 .. r_n, in the units of the template."""
        n = self.layout.plays
        return self.constants(theta)[n + 1 : 2 * n + 1]

    def operator(self, theta: Array) -> Operator:
        """Give the springs that bear anything, with sign and offset."""
        k, r = self.stiffnesses(theta), self.ways(theta)
        bears = k[1:] > 0.0
        stiffness = k[1:][bears]
        springs = models.MaxwellSlip(stiffness, stiffness * r[bears], float(k[0]))
        gain, offset = self.constants(theta)[-2:].tolist()
        return Affine(gain, offset) @ springs


@final
@dataclass(frozen=True)
class MaxwellSlip(PlayBank):
    """``y = sign (k0 u + sum_i k_i S_i[u]) + offset``, S_i the stop of threshold f_i / k_i.

    Parameters
    ----------
    plays, radii
        Number of elements, or ``"auto"``, and their ways to sliding f / k to keep, input units: see
        ``PlayBank``.
    """

    name = "maxwell-slip"
    in_reserve = "run direction"
    explains = ("run direction",)  # of a force over displacement it is right
    words = Words(
        full_name="Maxwell-slip friction model",
        equations=(
            "y(t) = {sign}F[u](t) + offset",
            "F[u](t) = k0 u(t) + \u03a3 k\u1d62 S\u1d62[u](t),  S\u1d62 a stop of radius "
            "f\u1d62/k\u1d62",
        ),
        explanations=(
            "Every element is a spring of stiffness k whose other end slides at a force of f; k0 "
            "is a spring that never slides. Their sum is stiff after a turn and gives way more "
            "and more, and its minor loops close.",
        ),
    )

    def least_parameters(self, size: int) -> int:
        """Give the number of stiffnesses, forces and the offset."""
        return 2 * size + 2

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Start from radii of equal shares of the curvature, in a geometric series, and others.

        Raises
        ------
        NotIdentifiableError
            If no spring slides within the records.
        """
        u, y = overview.input, overview.data.measured()
        line = y - np.polyval(np.polyfit(u - u.mean(), y, 1), u - u.mean())
        straight = float(np.sqrt(np.mean(line * line)))
        if fine_weights(overview, SLIDING).rms > SLIDES * straight:
            raise NotIdentifiableError(
                "nothing slides within the records: springs that do leave as much of the output as "
                "a straight line does; drive further, or use family 'pi' or 'linear'"
            )
        return super().starts(overview, size, most)

    def rule(self, overview: Overview) -> str:
        """Give that all stiffnesses are positive."""
        return SLIDING

    def first_radii(self, overview: Overview, size: int) -> list[Array]:
        """Give radii of equal shares of the curvature, and in a geometric series."""
        found = super().first_radii(overview, size)
        if self.radii is not None:
            return found
        series = np.geomspace(SHORTEST, 1.0, size + 2)[1:-1] if size > 1 else np.array([0.1])
        return [found[0], overview.data.largest_radius * series, *found[1:]]

    def parametrize(self, guess: FirstGuess) -> tuple[PlayParametrization, Array]:
        """Give stiffnesses, ways to sliding and offset."""
        template = Affine(guess.sign, guess.offset) @ guess.plays
        made, theta = parametrize_plays(template, guess, map_at=None)
        parts = {each.name: getattr(made, each.name) for each in fields(made)}
        return SlidingParametrization(**parts), theta

    def knots_over(self, overview: Overview, weights: Weights) -> Array:
        """Give none: there is no map."""
        return np.empty(0)

    def estimates(self, fit: Fit) -> Estimates:
        """Give k0, stiffnesses and forces of the elements that bear anything, and the offset."""
        parametrization, theta = fit.parametrization, fit.solution.theta
        assert isinstance(parametrization, SlidingParametrization), "this family made it"
        n, transform = parametrization.layout.plays, parametrization.transform
        k, r = parametrization.stiffnesses(theta), parametrization.ways(theta)
        by_stiffness = np.zeros((n + 1, theta.size))
        by_stiffness[:, : n + 1] = np.diag(transform[0, : n + 1])
        by_force = r[:, None] * by_stiffness[1:] + k[1:, None] * transform[n + 1 : 2 * n + 1]
        bears = np.flatnonzero(k[1:] > 0.0)
        constants = fit.operator.parameters()
        chosen = [i for i, name in enumerate(constants.names) if not name.endswith(".gain")]
        return Estimates(
            tuple(constants.names[i] for i in chosen),
            constants.values[chosen],
            np.concatenate(
                [by_stiffness[:1], by_stiffness[1:][bears], by_force[bears], transform[-1:]]
            ),
        )

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say how many elements came out idle, and if nothing holds the force in sliding."""
        said = super().notes(fit, data)
        if float(fit.operator.parameters().values[0]) > 0.0:
            return said
        return (
            *said,
            "k0 came out 0: when all elements slide the force stays, whatever the position, so "
            "that there is no inverse",
        )

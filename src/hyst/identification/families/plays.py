"""Prandtl-Ishlinskii models: what all models of plays have in common, and plays alone.

Cumulative weights are bounded from below, so every iterate is invertible.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start
from hyst.identification.families.option import (
    AUTO,
    Option,
    as_numbers,
    choice,
    option,
    read_numbers,
    whole_number_or_auto,
)
from hyst.identification.families.play_layout import (
    FirstGuess,
    PlayLayout,
    PlayParametrization,
    half_swings,
)
from hyst.identification.families.seldom_moved_plays import about_seldom_moved
from hyst.identification.fit.radius_search import search_radii
from hyst.identification.fit.weight_rules import INVERTIBLE, NON_NEGATIVE, RULES
from hyst.identification.fit.weights import Weights, fit_weights
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

SIZES = (1, 2, 3, 4, 6, 8, 10)
"""Numbers of plays that ``"auto"`` compares."""

MOST_PLAYS = 200
SMALLEST_RADIUS = float(np.finfo(float).tiny)
FINE_BANK = 60
"""Plays of a bank finer than any model."""

NEGATIVE_WEIGHTS_PAY = 0.9
"""Negative weights are thought of where they lower the residual of a fine bank below this share."""

PLAY_TEXT = (
    "F with radius r is a play (backlash of half-width r): its output rests until its input has "
    "come r away from it, and then follows at that distance. The sum of plays gives the loop and "
    "its minor loops; p0 is the part without hysteresis."
)


def radii_option(*, zero_too: bool = False) -> Option:
    """Give the option of radii to keep: ascending, each once, positive, or zero where it moves.

    Parameters
    ----------
    zero_too
        Whether a play of radius 0 is one, as where the rate widens it.
    """

    def check(radii: Any, name: str) -> tuple[float, ...] | None:
        if radii is None:
            return None
        least = 0.0 if zero_too else SMALLEST_RADIUS
        what = "one or more finite numbers " + ("from 0 on" if zero_too else "above 0")
        return tuple(np.unique(as_numbers(radii, name, what, least)).tolist())

    return Option(check, "Radii to keep, input units, as 0.5,1,2.", read_numbers, "R1,R2,..")


PLAYS_OPTION = whole_number_or_auto(1, MOST_PLAYS, "Number of plays.")
WEIGHTS_OPTION = choice(
    (AUTO, *RULES), "What weights may be; invertible: negative where the inverse allows."
)


@dataclass(frozen=True)
class PlayBank(Family):
    """What all models have in common that are found as rate-independent plays.

    Parameters
    ----------
    plays
        Number of plays, 1 to 200, or ``"auto"``: chosen by cross-validation. Plays whose weight
        comes out zero are left out of the model.
    radii
        Shape (n,), input units: keep these radii instead of finding them.
    """

    plays: Any = option(AUTO, PLAYS_OPTION)
    radii: Any = option(None, radii_option())

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.radii is not None and self.plays not in (AUTO, len(self.radii)):
            raise InputError(
                f"plays is {self.plays} but {len(self.radii)} radii are given; leave out plays"
            )

    @abstractmethod
    def parametrize(self, guess: FirstGuess) -> tuple[PlayParametrization, Array]:
        """Give the free parameters, and theta of a first guess with an identity map.

        Parameters
        ----------
        guess
            The first guess.
        """

    @abstractmethod
    def knots_over(self, overview: Overview, weights: Weights) -> Array:
        """Give the knots of the map over the signal it acts on, none at 0.

        Parameters
        ----------
        overview
            The records.
        weights
            Plays of the first guess.
        """

    @final
    def suited(self, data: Data) -> tuple[Self, tuple[str, ...]]:
        """Leave out radii the input never passes."""
        if self.radii is None:
            return self, ()
        reached = [r for r in self.radii if r < data.half_range]
        if not reached:
            raise NotIdentifiableError(
                f"no radius is below {data.half_range:.6g}, half the input range; a play that "
                "never moves cannot be identified"
            )
        notes = tuple(
            f"the play of radius {r:.6g} never moves: half the input range is "
            f"{data.half_range:.6g}; it was left out"
            for r in self.radii[len(reached) :]
        )
        return replace(self, plays=AUTO, radii=reached), notes

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with scaled radii."""
        if self.radii is None:
            return self
        return replace(self, radii=[r * input_scale for r in self.radii])

    @final
    def sizes(self) -> tuple[int, ...]:
        """Give the numbers of plays to compare."""
        if self.radii is not None:
            return (len(self.radii),)
        return SIZES if self.plays == AUTO else (self.plays,)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Start from radii of equal shares of the curvature, evenly spaced, and denser near 0."""
        return [self._start_from(overview, r) for r in self.first_radii(overview, size)[:most]]

    @final
    def finish(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Move the radii across the kinks of the cost."""
        records = overview.data.records
        kinks = np.unique(np.concatenate([half_swings(fit.operator, each.u) for each in records]))
        problem = fit.problem(overview.data, overview.kept)
        found = search_radii(
            problem,
            fit.solution,
            layout_of(fit).basis,
            kinks,
            max_iterations,
            one_amplitude=not overview.shows_minor_loops,
        )
        return replace(fit, solution=found)

    @final
    def simplified(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Fit again without the plays that came out idle, until none is."""
        while self.radii is None:
            working = _working_plays(fit, overview.data)
            if working.all():
                break
            fit = self._refit(fit, overview, working, max_iterations)
        return fit

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say how many plays came out idle, and what those do that hardly moved."""
        kept, seldom = layout_of(fit).plays, about_seldom_moved(fit.operator, data)
        if kept >= fit.size:
            return seldom
        idle = (
            f"{fit.size - kept} of {fit.size} plays came out with no weight or no radius "
            "of their own; they were left out"
        )
        return (idle, *seldom)

    def first_radii(self, overview: Overview, size: int) -> list[Array]:
        """Give the radii to start from, the best guess first.

        Parameters
        ----------
        overview, size
            As of ``starts``.
        """
        if self.radii is not None:
            return [np.array(self.radii)]
        largest = overview.data.largest_radius
        curvature = np.abs(fine_weights(overview, self.rule(overview)).p)
        # A floor keeps the radii apart where the bank puts all weight on a few plays.
        share = np.cumsum(curvature + 0.5 * max(curvature.mean(), np.finfo(float).tiny))
        levels = share[-1] * (np.arange(size) + 0.5) / size
        even = largest * np.arange(1, size + 1) / (size + 1)
        return [np.interp(levels, share, _fine_radii(overview)), even, even**2 / largest]

    @abstractmethod
    def rule(self, overview: Overview) -> str:
        """Give what the weights may be.

        Parameters
        ----------
        overview
            The records.
        """

    def _start_from(self, overview: Overview, r: Array) -> Start:
        guess = self._guess(overview, r)
        parametrization, theta = self.parametrize(guess)
        # A coefficient that starts on its bound would give its radius no derivative.
        coefficients = theta[: r.size + 1]
        theta[: r.size + 1] = np.maximum(coefficients, 0.01 * guess.mean_slope)
        return parametrization, theta

    def _guess(self, overview: Overview, r: Array) -> FirstGuess:
        rule = self.rule(overview)
        weights = fit_weights(overview.data, r, overview.sign, rule, overview.kept)
        return FirstGuess(
            p0=weights.p0,
            p=weights.p,
            r=r,
            offset=weights.offset,
            sign=overview.sign,
            knots=self.knots_over(overview, weights),
            largest_radius=overview.data.largest_radius,
            mean_slope=overview.mean_slope,
            rule=rule,
            fixed_radii=self.radii is not None,
        )

    def _refit(
        self, fit: Fit, overview: Overview, working: NDArray[np.bool_], max_iterations: int
    ) -> Fit:
        layout, theta = layout_of(fit), fit.solution.theta
        weights, r = layout.weights(theta), layout.radii(theta)
        guess = replace(
            self._guess(overview, r[working]),
            p0=float(weights[0]),
            p=weights_left(weights[1:], working),
            r=r[working],
        )
        parametrization, refitted = self.parametrize(guess)
        rest = theta.size - 2 * layout.plays - 1
        refitted[-rest:] = theta[-rest:]
        fit = replace(fit, parametrization=parametrization)
        solution = self.solve(fit.problem(overview.data, overview.kept), refitted, max_iterations)
        return replace(fit, solution=solution)


@dataclass(frozen=True)
class Plays(PlayBank):
    """What all models of plays have in common whose weights may have rules.

    Parameters
    ----------
    plays, radii
        As of ``PlayBank``.
    weights
        ``"non-negative"``; ``"invertible"``: single weights may be negative as long as the
        cumulative ones are positive, for loops that flatten after a reversal, as friction's do; or
        ``"auto"``: the latter where it is missed, which all families compared settle together.
    """

    weights: Any = option(AUTO, WEIGHTS_OPTION)

    def rule(self, overview: Overview) -> str:
        """Give what the weights may be; alone, ``auto`` allows negative ones where they help a lot.

        Parameters
        ----------
        overview
            The records.
        """
        if self.weights != AUTO:
            return str(self.weights)
        return INVERTIBLE if negative_weights_pay(overview) else NON_NEGATIVE

    def rules(self) -> tuple[str, ...]:
        """Give what the weights may be, as long as the user does not say it."""
        return RULES if self.weights == AUTO else ()

    @final
    def under(self, rule: str) -> Self:
        """Give the family with a rule of its weights."""
        return replace(self, weights=rule)


def fine_weights(overview: Overview, rule: str) -> Weights:
    """Give the weights of a bank finer than any model.

    Parameters
    ----------
    overview
        The records.
    rule
        What they may be.

    Returns
    -------
    Weights
    """
    return overview.once(
        ("fine weights", rule),
        lambda: fit_weights(
            overview.data, _fine_radii(overview), overview.sign, rule, overview.kept
        ),
    )


def negative_weights_pay(overview: Overview) -> bool:
    """Tell whether negative weights lower the residual of a fine bank by more than a tenth.

    Parameters
    ----------
    overview
        The records.
    """
    plain, free = (fine_weights(overview, rule).rms for rule in (NON_NEGATIVE, INVERTIBLE))
    return free < NEGATIVE_WEIGHTS_PAY * plain


def weights_left(p: Array, working: NDArray[np.bool_]) -> Array:
    """Give the weights of the plays that are kept, each with those of the ones left out after it.

    A play as wide as the one before it is left out, but not its weight: of two large ones of
    opposite signs neither means anything alone.

    Parameters
    ----------
    p
        Shape (n,), weights in the order of the radii.
    working
        Shape (n,), which plays to keep.
    """
    owner = np.cumsum(working) - 1
    kept: Array = np.zeros(int(working.sum()))
    np.add.at(kept, owner[owner >= 0], p[owner >= 0])
    return kept


def layout_of(fit: Fit) -> PlayLayout:
    """Give where the plays of a fit stand in its theta.

    Parameters
    ----------
    fit
        A fit of a model of plays.
    """
    parametrization = fit.parametrization
    assert isinstance(parametrization, PlayParametrization), "a family of plays made it"
    return parametrization.layout


def _fine_radii(overview: Overview) -> Array:
    return overview.data.largest_radius * np.arange(1, FINE_BANK + 1) / (FINE_BANK + 1)


def _working_plays(fit: Fit, data: Data) -> NDArray[np.bool_]:
    """Tell which plays have a weight, and a radius of their own."""
    layout, theta = layout_of(fit), fit.solution.theta
    weights, r = layout.weights(theta), layout.radii(theta)
    working = np.abs(weights[1:]) > 1e-6 * np.abs(weights).max()
    working[working] = np.diff(r[working], prepend=-np.inf) > 1e-4 * data.half_range
    return np.asarray(working)

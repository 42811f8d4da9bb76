"""LuGre friction: presliding, a Stribeck curve and viscosity, from displacement and force."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.checks.numbers import as_not_negative
from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import (
    AUTO,
    Option,
    choice,
    option,
    read_number,
)
from hyst.identification.families.sliding import (
    SlidingGuess,
    Terms,
    guesses,
    spread_of_speeds,
    velocities,
)
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Affine

Array = NDArray[np.float64]

FREE, NONE, LINEAR, SATURATING = "free", "none", "linear", "saturating"
ONE_VELOCITY = 1.5
"""Speeds of sliding within this factor are one: forces over velocity cannot be told from it."""
LEAST_REACHED = 0.5
"""Share of the force of sliding that a record must reach."""
WORTH = 1.02
"""By how much two constants more must lower the squared error; less is a seventh of its root."""
STEEPEST = 1e5
"""sigma0 over the mean slope: beyond, the way to sliding is nothing beside the input's range."""

_SIGMA0, _SIGMA1, _SIGMA2, _FC, _FS, _VS, _FV, _VV, _OFFSET = 0, 1, 2, 3, 4, 5, 6, 7, 9


def _as_damping(value: Any, name: str) -> str | float:
    if isinstance(value, str) and value == FREE:
        return FREE
    return as_not_negative(value, name, f"a number from 0 on, or {FREE!r}")


def _read_damping(text: str, name: str) -> Any:
    return text if text == FREE else read_number(text, name)


@final
@dataclass(frozen=True)
class LuGre(Family):
    """``y = sign F[u] + offset``, F LuGre friction: ``dz/dt = v - sigma0 |v| z / s(v)``.

    Parameters
    ----------
    sigma1
        Damping of the bristles, output units per input unit and second, 0 or more; or ``"free"``.
    stribeck
        Whether the force of sliding falls from Fs to Fc: ``"free"``, ``"none"`` for Fs = Fc, or
        ``"auto"``: the first where the records slide at more than one velocity and it is missed.
    viscosity
        ``"linear"``, sigma2 v; ``"saturating"``, Fv tanh(v / vv) beside it; ``"none"``; or
        ``"auto"``: the first, or the second where the records slide at more than one velocity and
        it is missed.
    """

    name = "lugre"
    in_reserve = "run direction"
    words = Words(
        full_name="LuGre friction model",
        equations=(
            "y(t) = {sign}F[u](t) + offset,  v = du/dt",
            "dz/dt = v - \u03c30 |v| z / s(v),  s(v) = Fc + (Fs - Fc) exp(-(v/vs)\u00b2)",
            "F = \u03c30 z + \u03c31 dz/dt + \u03c32 v + Fv tanh(v/vv)",
        ),
        explanations=(
            "Bristles of stiffness \u03c30 bend until they slide; sliding bears Fs when slow and "
            "Fc when fast, vs being the velocity between them (Stribeck curve).",
            "\u03c31 is the damping of the bristles, \u03c32 viscosity, and Fv, where it is asked "
            "for, what a viscosity that saturates ends at.",
        ),
    )
    methods = ("learning",)
    depends_on_rate = True
    # Of a force over displacement they are right.
    explains = ("run direction", "rate dependence", "dynamics")

    sigma1: Any = option(
        FREE, Option(_as_damping, "Damping of the bristles, or free.", _read_damping, "N|free")
    )
    stribeck: Any = option(
        AUTO, choice((AUTO, FREE, NONE), "Whether the force of sliding falls with the velocity.")
    )
    viscosity: Any = option(
        AUTO, choice((AUTO, LINEAR, SATURATING, NONE), "How the force grows with the velocity.")
    )

    def suited(self, data: Data) -> tuple[Self, tuple[str, ...]]:
        """Refuse what one velocity does not tell, or leave it out with a sentence."""
        spread = spread_of_speeds(data)
        if spread >= ONE_VELOCITY:
            return self, ()
        for name, value, other in (
            ("stribeck", self.stribeck, (AUTO, NONE)),
            ("viscosity", self.viscosity, (AUTO, LINEAR, NONE)),
        ):
            if value not in other:
                raise NotIdentifiableError(
                    f"the records slide at one velocity (fast and slow differ by a factor of "
                    f"{spread:.2f}), which does not tell how the force bends over it; give "
                    f"{name}={other[1]!r}, or records at several velocities"
                )
        grows = LINEAR if self.viscosity == AUTO else self.viscosity
        return replace(self, stribeck=NONE, viscosity=grows), (
            f"the records slide at one velocity (fast and slow differ by a factor of {spread:.2f}"
            "): Fs and vs cannot be told and were left out, and viscosity rests on how the force "
            "jumps at turns, so that the model holds at that velocity only; add records at other "
            "velocities",
        )

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with a scaled damping."""
        if self.sigma1 == FREE:
            return self
        return replace(self, sigma1=self.sigma1 * (output_scale / input_scale))

    def least_parameters(self, size: int) -> int:
        """Give the number of constants that are free, and the offset."""
        return len(self._places())

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best of a grid over the way to sliding and velocities, forces by least squares.

        Raises
        ------
        NotIdentifiableError
            If the output does not rise to a limit, or the records do not reach it.
        """
        found = guesses(overview, self._terms())
        if not found:
            raise NotIdentifiableError(
                "the output does not rise to a limit over the way since a turn, as friction does; "
                "use family 'pi' or 'linear'"
            )
        share = _share_reached(found[0].constants, overview.data)
        if share < LEAST_REACHED:
            raise NotIdentifiableError(
                f"the records reach {100.0 * share:.0f} % of the force of sliding only, so they "
                "do not show friction in sliding; drive further, or use family 'dahl' or "
                "'maxwell-slip', or 'pi' for what is no friction"
            )
        return [self._parametrize(overview, each) for each in found[: max(most, 2)]]

    def simplified(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Fit again without the terms that do not pay, of those that are there by themselves."""
        simpler = [
            replace(self, stribeck=falls, viscosity=grows)
            for falls in ((NONE, FREE) if self.stribeck == AUTO else (self.stribeck,))
            for grows in ((LINEAR, SATURATING) if self.viscosity == AUTO else (self.viscosity,))
        ]
        if len(simpler) == 1:
            return fit
        fits = [each._refitted(fit, overview, max_iterations) for each in simpler]
        plainest = fits[0]
        bounded = [each for each in fits[1:] if not _ends_on_a_bound(each)]
        rounding = fit.problem(overview.data, overview.kept).negligible
        return min((plainest, *bounded), key=lambda each: _price(each, rounding))

    def _refitted(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Fit these terms from what a richer fit found, and from the best guess."""
        constants = fit.operator.parameters().values
        found = SlidingGuess(0.0, tuple(constants[: _VV + 1].tolist()), float(constants[_OFFSET]))
        fits = []
        for guess in (found, *guesses(overview, self._terms())[:1]):
            parametrization, theta = self._parametrize(overview, guess)
            unsolved = Fit(self, fit.size, parametrization, fit.solution)
            problem = unsolved.problem(overview.data, overview.kept)
            fits.append(replace(unsolved, solution=self.solve(problem, theta, max_iterations)))
        return min(fits, key=lambda each: each.solution.cost)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what lies outside the records, and if friction gives energy away."""
        constants = fit.operator.parameters().values
        friction = _friction(constants, data.records[0].dt)
        speeds = np.abs(velocities(data))
        fastest, said = float(speeds.max()), []
        said += [_ON_BOUND[place] for place in _on_bounds(fit) if place in _ON_BOUND]
        if friction.Fs > friction.Fc:
            left = math.exp(-((fastest / friction.vs) ** 2))
            if left > 0.5:
                said.append(
                    f"the fastest sample, {fastest:.6g} input units a second, is within the fall "
                    f"of the Stribeck curve (vs = {friction.vs:.6g}): Fc is an extrapolation"
                )
        if friction.passivity_margin() < 0.0:
            said.append(
                f"sigma2 = {friction.sigma2:.6g} is less than sigma1 (Fs/Fc - 1) = "
                f"{friction.sigma1 * (friction.Fs / friction.Fc - 1.0):.6g}: this friction is not "
                "passive, it can give energy away in fast motion; give a smaller sigma1 for loops "
                "that must be stable"
            )
        return tuple(said)

    def _terms(self) -> Terms:
        return Terms(
            None if self.sigma1 == FREE else float(self.sigma1),
            self.stribeck != NONE,
            self.viscosity != NONE,
            self.viscosity in (AUTO, SATURATING),
        )

    def _places(self) -> list[int]:
        """Which constants of the operator theta names, in order."""
        terms = self._terms()
        return [
            _SIGMA0,
            *([_SIGMA1] if terms.damping is None else []),
            *([_SIGMA2] if terms.viscous else []),
            _FC,
            *([_FS, _VS] if terms.falls else []),
            *([_FV, _VV] if terms.thins else []),
            _OFFSET,
        ]

    def _parametrize(self, overview: Overview, guess: SlidingGuess) -> Start:
        """Lay out theta: the constants that are free, Fs as its excess over Fc, the offset."""
        terms, places = self._terms(), self._places()
        constants = np.array([*guess.constants, overview.sign, guess.offset])
        span, slope = overview.output_range, overview.mean_slope
        fastest = float(np.abs(velocities(overview.data)).max())
        if not terms.falls:
            constants[_FS], constants[_VS] = constants[_FC], fastest
        if not terms.thins:
            constants[_FV], constants[_VV] = 0.0, fastest
        if not terms.viscous:
            constants[_SIGMA2] = 0.0
        theta = constants.copy()
        # A force that starts at nothing would give its velocity no derivative.
        theta[_FS] = max(constants[_FS] - constants[_FC], 0.05 * constants[_FC])
        theta[_FV] = max(constants[_FV], 0.05 * constants[_FC])
        lower = np.array([1e-3 * slope, 0, 0, 1e-3 * span, 0, 0, 0, 0, 0, -np.inf])
        upper = np.array([STEEPEST * slope, *([np.inf] * 9)])
        lower[[_VS, _VV]], upper[[_VS, _VV]] = 1e-3 * fastest, 10.0 * fastest
        # What nothing in the records comes near is no force of theirs.
        upper[[_FC, _FS, _FV]] = span
        transform = np.eye(10)
        transform[_FS, _FC] = 1.0
        theta[_FS] = theta[_FS] if terms.falls else 0.0
        theta[_FV] = theta[_FV] if terms.thins else 0.0
        fixed = theta.copy()
        fixed[places] = 0.0
        friction = _friction(constants, overview.data.records[0].dt)
        template = Affine(overview.sign, guess.offset) @ friction
        parametrization = Parametrization(
            template, transform[:, places], transform @ fixed, lower[places], upper[places]
        )
        return parametrization, np.clip(theta[places], lower[places], upper[places])


def _friction(constants: Array, dt: float) -> models.LuGre:
    unit = models.LuGre(1.0, 0.0, 0.0, 1.0, 1.0, 1.0, dt)
    return unit.with_parameters(constants[: _VV + 1])


def _share_reached(constants: Sequence[float], data: Data) -> float:
    sigma0, force = constants[_SIGMA0], constants[_FC]
    return 1.0 - math.exp(-2.0 * data.half_range * sigma0 / force)


def _on_bounds(fit: Fit) -> list[int]:
    """Give the places of the constants whose free parameter is on a bound that no zero is."""
    parametrization, theta = fit.parametrization, fit.solution.theta
    stuck = (theta >= parametrization.upper) | ((theta <= parametrization.lower) & (theta > 0.0))
    places = fit.family._places() if isinstance(fit.family, LuGre) else []
    return [place for place, each in zip(places, stuck, strict=True) if each]


def _ends_on_a_bound(fit: Fit) -> bool:
    return any(place in (_FC, _FS, _VS, _FV, _VV) for place in _on_bounds(fit))


def _price(fit: Fit, rounding: float) -> float:
    """Give the cost of a fit with what its terms must be worth; rounding is worth none."""
    return max(fit.solution.cost, rounding) * math.pow(WORTH, 0.5 * fit.parametrization.size)


_ON_BOUND = {
    _SIGMA0: "the records slide right after a turn: sigma0 is on its bound, and only known to be "
    "large",
    _FC: "Fc is on its bound: within the velocities of the records the force of sliding falls to "
    "next to nothing; give stribeck='none', or viscosity='saturating'",
    _FS: "Fs is on its bound: slow sliding bears more than anything in the records, so Fs is an "
    "extrapolation; record slow sliding",
    _VS: "vs is on its bound: where the force of sliding falls lies outside the velocities of the "
    "records",
    _FV: "Fv is on its bound: viscosity saturates, if at all, beyond the forces of the records",
    _VV: "vv is on its bound: where viscosity saturates lies outside the velocities of the records",
}

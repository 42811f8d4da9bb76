"""Iwan's model of joints: sliders whose ways to slip are spread by a power law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.checks.numbers import as_number, said
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import Option, choice, option, read_number
from hyst.identification.families.power_law_fit import SMALLEST_GAIN
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization, selection
from hyst.identification.fit.problem import model_output
from hyst.identification.fit.shape_search import saved_beside_a_line, shares
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Affine, Operator, Stop

Array = NDArray[np.float64]

FREE, NONE = "free", "none"
LEAST_CHI, LARGEST_CHI = -0.9, 5.0
"""Of chi, if it is free: below, next to all elements slip at once at 0."""
LARGEST_BETA = 20.0
"""Of beta, if it is free: beyond, all elements are one, a single slider."""

_SPREADS = (-0.8, -0.5, -0.2, 0.1, 0.5, 1.0, 2.0, 4.0)
_LIMITS = np.geomspace(0.08, 1.6, 16)
"""phi_max of first guesses, over half the input range."""


def _number_or_free(low: float, high: float) -> Any:
    def check(value: Any, name: str) -> str | float:
        if isinstance(value, str) and value == FREE:
            return FREE
        try:
            number = as_number(value, name)
        except InputError:
            number = np.nan
        if not low <= number <= high:
            raise InputError(f"{name} is {said(value)}; give {low:g} to {high:g}, or {FREE!r}")
        return number

    return check


def _read(text: str, name: str) -> Any:
    return text if text == FREE else read_number(text, name)


@final
@dataclass(frozen=True)
class Iwan(Family):
    """``y = sign I[u] + offset``, I Iwan's model with Segalman's four parameters and a spring.

    Parameters
    ----------
    chi
        Exponent of the spread of the ways to slip, -0.9 to 5, kept; or ``"free"``. 0 is Iwan's
        uniform spread.
    beta
        Stiffness of the elements that slip last over that of all others, 0 to 20, kept; or
        ``"free"``.
    spring
        ``"free"``: a stiffness K_inf is left in macro-slip; ``"none"``: it is 0, and there is no
        inverse.
    """

    name = "iwan"
    in_reserve = "run direction"
    explains = ("run direction",)  # of a force over displacement it is right
    words = Words(
        full_name="Iwan model of joints",
        equations=(
            "y(t) = {sign}I[u](t) + offset",
            "\u03c1(\u03c6) ~ \u03c6^\u03c7 up to \u03c6_max, the rest slips at \u03c6_max",
        ),
        explanations=(
            "Springs with a slider each act in parallel; \u03c1 says how the ways \u03c6 at which "
            "they slip are spread. K_T is the stiffness right after a turn, F_S the force at which "
            "all of them slip (macro-slip), \u03c7 (chi) the exponent of the spread, \u03b2 (beta) "
            "how sudden macro-slip is, and K_inf the stiffness that is left then.",
        ),
    )
    has_memory = False  # a delay bends such a loop as another spread does

    chi: Any = option(
        FREE,
        Option(
            _number_or_free(LEAST_CHI, LARGEST_CHI),
            "Exponent of the spread of sliders (0: uniform), or free.",
            _read,
            "N|free",
        ),
    )
    beta: Any = option(
        FREE,
        Option(
            _number_or_free(0.0, LARGEST_BETA),
            "Stiffness of the last sliders over the others, or free.",
            _read,
            "N|free",
        ),
    )
    spring: Any = option(
        FREE, choice((FREE, NONE), "Stiffness left in macro-slip: free, or none (no inverse).")
    )

    def least_parameters(self, size: int) -> int:
        """Give 3, F_S, K_T and the offset, and one for chi, beta and K_inf where they are free."""
        return 3 + [self.chi, self.beta, self.spring].count(FREE)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best points of a grid over chi and phi_max, the rest by least squares."""
        unit = overview.data.half_range
        spreads = _SPREADS if self.chi == FREE else (float(self.chi),)
        guesses = [
            (*self._guess(overview, chi, float(limit) * unit), limit)
            for chi in spreads
            for limit in _LIMITS
        ]
        guesses.sort(key=lambda each: each[0])
        left, constants, limit = guesses[0]
        # K_T of the best, over what a spring alone would have.
        if not constants[1] > SMALLEST_SLOPE * overview.mean_slope:
            raise NotIdentifiableError(
                "the output does not soften after a turn, as sliding does; use family 'masing', "
                "'pi' or 'linear'"
            )
        y = overview.data.measured()
        line, target = overview.input - overview.input.mean(), y - y.mean()
        if saved_beside_a_line(line, target, left) < SMALLEST_GAIN:
            raise NotIdentifiableError(
                "sliding describes the records no better than a straight line: their slope does "
                "not fall after a turn, but for noise; use family 'linear', 'masing' or 'pi'"
            )
        if limit >= 1.0:
            raise NotIdentifiableError(
                "the records do not reach macro-slip, where all elements slide: what F_S and beta "
                "are they do not tell; drive further, or use family 'masing' or 'pi'"
            )
        guesses = [each for each in guesses if each[2] < 1.0 and each[1][1] > 0.0]
        return [self._parametrize(overview, each[1]) for each in guesses[: max(most, 2)]]

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say which constants are on a bound, or an extrapolation."""
        values = fit.operator.parameters().values
        reached = models.Iwan(*values[:5].tolist()).phi_max
        said = []
        if reached > data.half_range:
            said.append(
                f"macro-slip begins at {reached:.4g}, beyond half the input range "
                f"{data.half_range:.4g}: F_S and beta are extrapolations; drive the actuator "
                "further"
            )
        # theta is in the units of the fit, as its bounds are.
        theta, shape, places = fit.solution.theta, fit.parametrization, self._places()
        for name, place in (("chi", 2), ("beta", 3)):
            at = places.index(place) if place in places else None
            if at is not None and (
                theta[at] >= shape.upper[at] or theta[at] <= shape.lower[at] < 0.0
            ):
                said.append(f"{name} came out at its limit {theta[at]:.4g}, so it is no estimate")
        if 4 in places and theta[places.index(4)] <= shape.lower[places.index(4)]:
            said.append(
                "K_inf came out at its lower bound, a thousandth of the mean slope: the output "
                "hardly moves in macro-slip; the option spring 'none' has none"
            )
        return tuple(said)

    def _guess(self, overview: Overview, chi: float, limit: float) -> tuple[float, list[float]]:
        """Residual, and F_S, K_T, chi, beta, K_inf of the best sum of elements."""
        share = (chi + 1.0) / (chi + 2.0)
        given = 0.0 if self.beta == FREE else float(self.beta)
        spread = models.Iwan(limit * (share + given) / (1.0 + given), 1.0, chi, given)
        elements: list[Operator] = [spread]
        elements += [Stop(limit)] if self.beta == FREE else []
        elements += [Affine(1.0)] if self.spring == FREE else []
        key = ("iwan", chi, limit, given, len(elements))

        def solved() -> tuple[Array, float]:
            columns = [model_output(overview.data, each) for each in elements]
            y = overview.sign * overview.data.measured()
            return shares(np.column_stack([c - c.mean() for c in columns]), y - y.mean())

        found, left = overview.once(key, solved)
        weights = found.tolist()
        last = weights[1] if self.beta == FREE else given * weights[0] / (1.0 + given)
        others = weights[0] if self.beta == FREE else weights[0] / (1.0 + given)
        others = max(others, last / LARGEST_BETA)
        k_inf = weights[-1] if self.spring == FREE else 0.0
        beta = given if self.beta != FREE else last / others if others > 0.0 else 0.0
        return left, [limit * (others * share + last), others + last, chi, beta, k_inf]

    def _places(self) -> list[int]:
        """Which constants of the model are free."""
        told = {2: self.chi, 3: self.beta, 4: self.spring}
        return [0, 1, *(place for place, given in told.items() if given == FREE)]

    def _parametrize(self, overview: Overview, constants: list[float]) -> Start:
        """Lay out theta = (F_S, K_T, chi, beta, K_inf, offset), without what is kept."""
        slope, span = overview.mean_slope, overview.output_range
        places = self._places()
        lower = np.array([1e-3 * span, 1e-3 * slope, LEAST_CHI, 0.0, SMALLEST_SLOPE * slope])
        upper = np.array([np.inf, np.inf, LARGEST_CHI, LARGEST_BETA, np.inf])
        values = np.array(constants)
        values[places] = np.clip(values, lower, upper)[places]
        model = models.Iwan(*values.tolist())
        modelled = overview.sign * model_output(overview.data, model)
        offset = float(np.mean(overview.data.measured() - modelled))
        template = Affine(overview.sign, offset) @ model
        free = [*places, 6]
        fixed = template.parameters().values.copy()
        theta = fixed[free]
        fixed[free] = 0.0
        return Parametrization(
            template,
            selection(7, free),
            fixed,
            np.append(lower[places], -np.inf),
            np.append(upper[places], np.inf),
        ), theta

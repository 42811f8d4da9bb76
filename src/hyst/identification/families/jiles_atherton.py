"""Jiles and Atherton's hysteresis: a magnetisation that lags its anhysteretic curve."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import choice, option
from hyst.identification.fit.bounded_least_squares import Problem, Solution
from hyst.identification.fit.normal_equations import NormalEquations
from hyst.identification.fit.parametrization import Parametrization, selection
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models.jiles_atherton import MOST_UNEQUAL, VARIANTS
from hyst.operators import Affine

Array = NDArray[np.float64]

MOST_COUPLING = 0.98
"""Of alpha Ms / (3 a): at 1 the magnetisation jumps."""
LEAST_REVERSIBLE, MOST_REVERSIBLE = 0.01, 0.95
"""Of c: without any the magnetisation rests after a turn and has no inverse."""

_SHAPES = (0.04, 0.12, 0.4)
"""a of first guesses, over half the input range."""
_PINNINGS = (1.0, 2.0, 4.0)
"""k of first guesses, over the coercive field."""
_COUPLINGS = (0.3, 0.8)
_REVERSIBLE = (0.15, 0.6)
_GAIN_OF_A_LOOP = 0.8
"""Share of what an anhysteretic curve leaves that a loop that lags leaves at most."""


@final
@dataclass(frozen=True)
class JilesAtherton(Family):
    """``y = sign M[u] + offset``, M the magnetisation of Jiles and Atherton in the output's unit.

    Parameters
    ----------
    variant
        ``"effective-field"``, ``"jiles-thoelke-devine-1992"`` or ``"jiles-atherton-1986"``.
    """

    name = "jiles-atherton"
    in_reserve = True
    words = Words(
        full_name="Jiles-Atherton model",
        equations=(
            "y(t) = {sign}M[u](t) + offset",
            "M = c Man + (1 - c) Mirr,  Man = Ms L((u + \u03b1 M)/a),  L(x) = coth x - 1/x",
            "k dMirr = |Man - Mirr| |d(u + \u03b1 M)| towards Man, 0 away from it",
        ),
        explanations=(
            "The magnetisation lags the anhysteretic curve Man, whose saturation is Ms and whose "
            "shape is a; pinning k sets the width of the loop, c is the share that is reversible, "
            "and the coupling \u03b1 (alpha) makes the loop steeper. Other variants of the model "
            "differ in what the pinned part follows.",
        ),
    )

    variant: Any = option(
        VARIANTS[0], choice(VARIANTS, "Which equations of Jiles and Atherton: see the docs.")
    )

    def least_parameters(self, size: int) -> int:
        """Give 6: Ms, a, k, c, alpha and the offset."""
        return 6

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best points of a grid around the coercive field, Ms by least squares."""
        half = overview.data.half_range
        field = _coercive_field(overview)
        grid = itertools.product(_SHAPES, _PINNINGS, _COUPLINGS, _REVERSIBLE)
        guesses = [
            self._guess(overview, shape * half, pinning * field, coupling, reversible)
            for shape, pinning, coupling, reversible in grid
        ]
        guesses = [each for each in guesses if each[1][0] > 0.0]
        guesses.sort(key=lambda each: each[0])
        without = _residual_without_loop(overview)
        if not guesses or guesses[0][0] > _GAIN_OF_A_LOOP * without:
            raise NotIdentifiableError(
                "the output shows no loop around a curve that saturates, as a magnet does; use "
                "family 'pi' or 'linear'"
            )
        return [self._parametrize(overview, *guess) for _, guess in guesses[: max(most, 2)]]

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = 1e-3
    ) -> Solution:
        """Fit over alpha Ms / (3 a) instead of alpha: its bound keeps every iterate a magnet."""
        posed, start, back = self.in_own_coordinates(problem, theta)
        found = super().solve(posed, start, max_iterations, tolerance)
        return replace(found, theta=back(found.theta))

    def in_own_coordinates(
        self, problem: Problem, theta: Array
    ) -> tuple[Problem, Array, Callable[[Array], Array]]:
        """Pose a problem over alpha Ms / (3 a) instead of alpha."""
        return _over_coupling(problem), _coupled(theta), _uncoupled

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what is an extrapolation, and what ended at a limit."""
        saturation, a, _, c, alpha = fit.operator.parameters().values[:5].tolist()
        told = []
        share = float(np.ptp(data.measured())) / (2.0 * saturation)
        if share < 0.5:
            told.append(
                f"the record reaches {100.0 * share:.0f} % of the saturation only: Ms and a are "
                "extrapolations; drive the magnet further"
            )
        coupling = alpha * saturation / (3.0 * a)
        if coupling > MOST_COUPLING - 1e-3:
            told.append(
                f"alpha Ms / (3 a) came out at its limit {MOST_COUPLING}: the loop is steeper than "
                "the model can be without a jump, so Ms, a and alpha are no estimates"
            )
        if not LEAST_REVERSIBLE + 1e-4 < c < MOST_REVERSIBLE - 1e-4:
            told.append(
                f"c came out at its limit {c:.2g}: what the record shows right after a turn is not "
                "what this variant does there, so that small loops may be far off"
            )
        return tuple(told)

    def _guess(
        self, overview: Overview, a: float, k: float, coupling: float, reversible: float
    ) -> tuple[float, tuple[float, ...]]:
        """Residual, and Ms, a, k, c, alpha and offset of the best saturation."""
        unit = models.JilesAtherton(1.0, a, k, reversible, 3.0 * a * coupling, self.variant)
        shape = overview.sign * model_output(overview.data, unit)
        residual, saturation, offset = _line_through(shape, overview.data.measured())
        alpha = 3.0 * a * coupling / saturation if saturation > 0.0 else 0.0
        return residual, (saturation, a, k, reversible, alpha, offset)

    def _parametrize(
        self,
        overview: Overview,
        saturation: float,
        a: float,
        k: float,
        c: float,
        alpha: float,
        offset: float,
    ) -> Start:
        """Lay out theta = (Ms, a, k, c, alpha, offset)."""
        places = [0, 1, 2, 3, 4, 6]
        model = models.JilesAtherton(saturation, a, k, c, alpha, self.variant)
        template = Affine(overview.sign, offset) @ model
        fixed = template.parameters().values.copy()
        theta = fixed[places]
        fixed[places] = 0.0
        half, span = overview.data.half_range, overview.output_range
        lower = [0.3 * span, 1e-3 * half, 1e-3 * half, LEAST_REVERSIBLE, 0.0, -np.inf]
        # A hundred times the range reached is a straight line to a part in ten thousand.
        upper = [100.0 * span, 100.0 * half, 100.0 * half, MOST_REVERSIBLE, np.inf, np.inf]
        parametrization = Parametrization(
            template,
            selection(7, places),
            fixed,
            np.array(lower),
            np.array(upper),
            is_allowed=_can_be_computed,
        )
        return parametrization, theta


def _can_be_computed(theta: Array) -> bool:
    """Tell whether k / a is within what the model takes, with room for a change of units."""
    ratio = float(theta[2] / theta[1])
    return MOST_UNEQUAL * ratio > 1.0 + 1e-9 and ratio < MOST_UNEQUAL * (1.0 - 1e-9)


def _coupled(theta: Array) -> Array:
    """Put alpha Ms / (3 a) in the place of alpha."""
    saturation, a, alpha = theta[0], theta[1], theta[4]
    return np.array([*theta[:4], alpha * saturation / (3.0 * a), *theta[5:]])


def _uncoupled(theta: Array) -> Array:
    """Put alpha in the place of alpha Ms / (3 a)."""
    saturation, a, coupling = theta[0], theta[1], theta[4]
    return np.array([*theta[:4], 3.0 * a * coupling / saturation, *theta[5:]])


def _over_coupling(problem: Problem) -> Problem:
    """Pose the problem over alpha Ms / (3 a) in the place of alpha."""

    def residual(theta: Array) -> Array:
        return problem.residual(_uncoupled(theta))

    def linearize(theta: Array) -> tuple[Array, Array]:
        plain = _uncoupled(theta)
        left, jacobian = problem.linearize(plain)
        return left, jacobian @ _by_coupled(plain)

    def summed(theta: Array) -> NormalEquations:
        plain = _uncoupled(theta)
        return problem.normal_equations(plain).over(_by_coupled(plain))

    def squares(theta: Array) -> float:
        return problem.cost(_uncoupled(theta))

    lower, upper = problem.lower.copy(), problem.upper.copy()
    lower[4], upper[4] = 0.0, MOST_COUPLING
    return replace(
        problem,
        linearize=linearize,
        residual=residual,
        lower=lower,
        upper=upper,
        summed=summed,
        squares=squares,
        blocks=None,
    )


def _by_coupled(plain: Array) -> Array:
    """Give the derivative of what ``_uncoupled`` gives by what it takes, shape (m, m)."""
    saturation, a, alpha = plain[0], plain[1], plain[4]
    change = np.eye(plain.size)
    change[4, 0], change[4, 1] = -alpha / saturation, alpha / a
    change[4, 4] = 3.0 * a / saturation
    return change


def _coercive_field(overview: Overview) -> float:
    """Half the width of the loop at half its height, at least a hundredth of half the range."""
    u, y = overview.input, overview.data.measured()
    above = y - 0.5 * (float(y.min()) + float(y.max()))
    crosses = np.flatnonzero(above[1:] * above[:-1] < 0.0)
    half = overview.data.half_range
    if crosses.size < 2:
        return 0.1 * half
    share = above[crosses] / (above[crosses] - above[crosses + 1])
    places = u[crosses] + share * (u[crosses + 1] - u[crosses])
    low, high = np.quantile(places, (0.1, 0.9))
    return max(0.5 * float(high - low), 1e-2 * half)


def _line_through(shape: Array, y: Array) -> tuple[float, float, float]:
    """Residual, factor and offset that bring a shape closest to the output."""
    centred = shape - shape.mean()
    factor = float(centred @ y) / max(float(centred @ centred), 1e-300)
    offset = float(np.mean(y - factor * shape))
    left = y - factor * shape - offset
    return float(left @ left), factor, offset


def _residual_without_loop(overview: Overview) -> float:
    """Of the best Langevin curve, or line."""
    u, half = overview.input, overview.data.half_range
    shapes = [u, *(_langevin(u / (share * half)) for share in (0.02, *_SHAPES, 1.0))]
    return min(_line_through(shape, overview.data.measured())[0] for shape in shapes)


def _langevin(x: Array) -> Array:
    far = np.where(np.abs(x) < 1e-3, 1.0, x)
    return np.where(np.abs(x) < 1e-3, x / 3.0, 1.0 / np.tanh(far) - 1.0 / far)

"""Dahl's friction: a force that approaches its Coulomb limit over the way since a turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.checks.numbers import as_positive
from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import Option, option, read_number
from hyst.identification.fit.parametrization import Parametrization, selection
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Affine

Array = NDArray[np.float64]

FREE = "free"
LEAST_SHAPE, LARGEST_SHAPE = 0.2, 5.0
"""Of n, if it is free: beyond, loops of another n are the same to a percent."""

_TRAVELS = np.geomspace(0.03, 3.0, 13)
"""Fc / sigma of first guesses, over half the input range."""
_SHAPES = (0.5, 1.0, 2.0)
MOST_GIVEN = 100.0
"""Of a shape n that is given: beyond, the force stays next to nothing."""


def _as_exponent(value: Any, name: str) -> str | float:
    if isinstance(value, str) and value == FREE:
        return FREE
    return as_positive(value, name, f"a number or {FREE!r}", most=MOST_GIVEN)


def _read_exponent(text: str, name: str) -> Any:
    return text if text == FREE else read_number(text, name)


@final
@dataclass(frozen=True)
class Dahl(Family):
    """``y = sign F[u] + offset``, ``dF/du = sigma |1 - s F/Fc|^n sgn(1 - s F/Fc)``, s = sgn(du).

    Parameters
    ----------
    exponent
        n, > 0 and at most 100, kept; or ``"free"``, to be found between 0.2 and 5.
    """

    name = "dahl"
    in_reserve = True
    explains = ("run direction",)  # of a force over displacement it is right
    words = Words(
        full_name="Dahl friction model",
        equations=(
            "y(t) = {sign}F[u](t) + offset",
            "dF/du = \u03c3 |1 - s F/Fc|^n sgn(1 - s F/Fc),  s = sgn(du)",
        ),
        explanations=(
            "Right after a turn the force rises with the stiffness \u03c3 (sigma) at rest; the "
            "further the way, the closer it comes to the Coulomb force Fc, faster for smaller n. "
            "Loops do not close after minor loops, as those of plays do.",
        ),
    )

    exponent: Any = option(
        1.0,
        Option(_as_exponent, "Shape n of the rise to a limit, or free.", _read_exponent, "N|free"),
    )

    def least_parameters(self, size: int) -> int:
        """Give 3, sigma, Fc and the offset, and one more if n is free."""
        return 3 + int(self.exponent == FREE)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best points of a grid over travel and shape, Fc by least squares."""
        shapes = _SHAPES if self.exponent == FREE else (float(self.exponent),)
        guesses = [
            self._guess(overview, float(travel) * overview.data.half_range, shape)
            for shape in shapes
            for travel in _TRAVELS
        ]
        guesses = [each for each in guesses if each[1][1] > 0.0]
        if not guesses:
            raise NotIdentifiableError(
                "the output does not rise to a limit over the way since a turn, as friction does; "
                "use family 'pi' or 'linear'"
            )
        guesses.sort(key=lambda each: each[0])
        return [self._parametrize(overview, *guess) for _, guess in guesses[: max(most, 2)]]

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say if the force is far from its limit, so that Fc is an extrapolation."""
        sigma, force = fit.operator.parameters().values[:2]
        share = 1.0 - float(np.exp(-2.0 * data.half_range * sigma / force))
        if share > 0.5:
            return ()
        return (
            f"the record reaches {100.0 * share:.0f} % of the Coulomb force only: Fc is an "
            "extrapolation, and what the record shows is the stiffness sigma and how it begins to "
            "fall; drive the actuator further",
        )

    def _guess(
        self, overview: Overview, travel: float, n: float
    ) -> tuple[float, tuple[float, float, float, float]]:
        """Residual, and sigma, Fc, n and offset of the best force for a travel and a shape."""
        unit = overview.sign * model_output(overview.data, models.Dahl(1.0 / travel, 1.0, n))
        y = overview.data.measured()
        centred = unit - unit.mean()
        force = float(centred @ y) / float(centred @ centred)
        offset = float(np.mean(y - force * unit))
        left = y - force * unit - offset
        return float(left @ left), (force / travel, force, n, offset)

    def _parametrize(
        self, overview: Overview, sigma: float, force: float, n: float, offset: float
    ) -> Start:
        """Lay out theta = (sigma, Fc, n, offset), n only if it is free."""
        free = self.exponent == FREE
        places = [0, 1, 2, 4] if free else [0, 1, 4]
        template = Affine(overview.sign, offset) @ models.Dahl(sigma, force, n)
        fixed = template.parameters().values.copy()
        theta = fixed[places]
        fixed[places] = 0.0
        slope, span = overview.mean_slope, overview.output_range
        lower = [1e-3 * slope, 1e-3 * span, *([LEAST_SHAPE] if free else []), -np.inf]
        # A hundred times the range reached is a straight line to a part in a hundred.
        upper = [np.inf, 100.0 * span, *([LARGEST_SHAPE] if free else []), np.inf]
        parametrization = Parametrization(
            template, selection(5, places), fixed, np.array(lower), np.array(upper)
        )
        return parametrization, theta

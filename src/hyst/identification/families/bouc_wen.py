"""Bouc-Wen's model: a straight line and a state that closes in on a limit after every turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.checks.numbers import as_positive
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import Option, choice, option, read_number
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models.bouc_wen import LARGEST_EXPONENT, LEAST_EXPONENT
from hyst.operators import Affine

Array = NDArray[np.float64]

FREE, EQUAL = "free", "equal"
LEAST_SHAPE, LARGEST_SHAPE = 0.3, 8.0
"""Of n, if it is free: beyond, loops of another n are the same to a percent."""

_TRAVELS = np.geomspace(0.1, 40.0, 11)
"""Way to the limit at the slope of z = 0, of first guesses, over half the input range."""
_RATIOS = (0.0, 0.4, 1.5)
"""(beta - gamma) / (beta + gamma) of first guesses."""
_SHAPES = (0.5, 1.0, 2.0)
_WEAKEST = 0.02
"""Of beta + gamma in a fit, over its first guess; with it how much steeper unloading may get."""
_SHOWN = 40.0
"""By how many variances of what is left a loop must beat a straight line."""
_K, _A, _BETA, _GAMMA, _N, _PHI, _OFFSET = 0, 1, 2, 3, 4, 5, 7
"""Places among the constants; 6 is the sign of the output."""


def _as_exponent(value: Any, name: str) -> str | float:
    if isinstance(value, str) and value == FREE:
        return FREE
    number = as_positive(value, name, f"a number or {FREE!r}", most=LARGEST_EXPONENT)
    if number < LEAST_EXPONENT:
        raise InputError(f"{name} is {number:g}; give {LEAST_EXPONENT:g} or more, or {FREE!r}")
    return number


def _read_exponent(text: str, name: str) -> Any:
    return text if text == FREE else read_number(text, name)


class _Guess(NamedTuple):
    left: float  # squared error
    k: float
    limit: float
    rate: float
    ratio: float
    n: float
    h: float
    offset: float


def _differ(one: _Guess, other: _Guess) -> bool:
    away = max(one.rate, other.rate) > 5.0 * min(one.rate, other.rate)
    return away or one.h != other.h or one.n != other.n


@final
@dataclass(frozen=True)
class BoucWen(Family):
    """``y = sign (k u + h z) + offset``, ``dz = (A - |z|^n (beta sgn(z du) + gamma)) du``.

    Parameters
    ----------
    exponent
        n, 0.1 to 100, kept; or ``"free"``, to be found between 0.3 and 8.
    asymmetry
        ``"equal"`` limits of z on both sides, or ``"free"``: the constant phi is found too.
    """

    name = "bouc-wen"
    in_reserve = True
    explains = ("run direction",)  # of a force over displacement it is right
    words = Words(
        full_name="Bouc-Wen model",
        equations=(
            "y(t) = {sign}(k u(t) + h z(t)) + offset,  h = 1 or -1",
            "dz/du = A - |z|^n (\u03b2 sgn(z du) + \u03b3 + \u03c6 (sgn(du) + sgn(z)))",
        ),
        explanations=(
            "z closes in on a limit, (A / (\u03b2 + \u03b3))^(1/n), over the way since a turn: "
            "sharply for a large n. With h = -1, as in piezos, the loop gets steeper on the way, "
            "with h = 1, as in springs that yield, flatter. Unloading is steeper than z = 0 by "
            "\u03b2 - \u03b3 (beta - gamma). Loops do not close after minor loops, as those of "
            "plays do.",
        ),
    )

    exponent: Any = option(
        1.0,
        Option(_as_exponent, "Shape n of the rise to a limit, or free.", _read_exponent, "N|free"),
    )
    asymmetry: Any = option(
        EQUAL, choice((EQUAL, FREE), "Limits on both sides of a loop: equal, or each its own.")
    )

    def least_parameters(self, size: int) -> int:
        """Give 5, k, A, beta, gamma and the offset, and one more each if n and phi are free."""
        return 5 + int(self.exponent == FREE) + int(self.asymmetry == FREE)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best points of a grid over way, steepness and shape."""
        shapes = _SHAPES if self.exponent == FREE else (float(self.exponent),)
        guesses = sorted(
            (
                self._guess(overview, float(travel) * overview.data.half_range, ratio, n)
                for n in shapes
                for ratio in _RATIOS
                for travel in _TRAVELS
            ),
            key=lambda each: each.left,
        )
        best = [each for each in guesses if each.k >= 0.0]
        if not best:
            raise NotIdentifiableError(
                "the output is no rising line with a loop around it, as Bouc-Wen's is; "
                "use family 'pi' or 'linear'"
            )
        self._require_a_loop(overview, best[0])
        # Loops of a long way and little of it look like loops of a short one with a weak z.
        apart: list[_Guess] = []
        for each in best:
            if all(_differ(each, other) for other in apart):
                apart.append(each)
        return [self._parametrize(overview, each) for each in apart[: max(most, 2)]]

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say if z is far from its limit, and if gamma lies where it ends being admissible."""
        _, a, beta, gamma, n = fit.operator.parameters().values[:5]
        limit = (a / (beta + gamma)) ** (1.0 / n)
        said = []
        share = 2.0 * data.half_range * a / limit
        if share < 1.0:
            said.append(
                f"a full stroke is {100.0 * share:.0f} % of the way to the limit of z at the slope "
                "A only: what limits z is an extrapolation, and k and A are seen as their sum; "
                "drive the actuator further"
            )
        if gamma >= beta * (1.0 - 1e-9):
            said.append(
                "gamma has come to beta, beyond which a loop would not dissipate: unloading is "
                "straight, and the record asks for less than that"
            )
        return tuple(said)

    def _guess(self, overview: Overview, travel: float, ratio: float, n: float) -> _Guess:
        """Best k, limit, sign of the loop and offset for z as a share of its limit."""
        # Limit and rate of a share: A = 1 / travel, beta + gamma the same.
        rate = 1.0 / travel
        beta, gamma = 0.5 * rate * (1.0 + ratio), 0.5 * rate * (1.0 - ratio)
        share = model_output(overview.data, models.BoucWen(0.0, rate, beta, gamma, n))
        columns = np.column_stack([overview.input, share, np.ones(share.size)])
        y = overview.sign * overview.data.measured()
        found, *_ = np.linalg.lstsq(columns, y, rcond=None)
        left = y - columns @ found
        k, loop, offset = found.tolist()
        h = 1.0 if loop >= 0.0 else -1.0
        limit = max(abs(loop), 1e-6 * overview.output_range)
        return _Guess(float(left @ left), k, limit, rate, ratio, n, h, offset * overview.sign)

    def _require_a_loop(self, overview: Overview, best: _Guess) -> None:
        """Refuse records in which a straight line leaves as little."""
        y, u = overview.data.measured(), overview.input
        columns = np.column_stack([u, np.ones(u.size)])
        left = y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]
        line = float(left @ left)
        rounding = y.size * (1e-9 * overview.output_range) ** 2
        if line <= rounding or line - best.left <= _SHOWN * best.left / y.size:
            raise NotIdentifiableError(
                "a straight line leaves as little of the output as a Bouc-Wen loop does, so that "
                "there is no loop to identify; use family 'linear'"
            )

    def _parametrize(self, overview: Overview, guess: _Guess) -> Start:
        """Lay out theta = (k, A, held above, held below, beta - gamma, n, offset).

        ``beta + gamma +- 2 phi`` hold z on its two sides; that they and ``beta - gamma`` are
        positive is all that admissible constants must be: bounds keep every iterate so.
        """
        a = guess.limit * guess.rate
        held = a / guess.limit**guess.n
        free, apart = self.exponent == FREE, self.asymmetry == FREE
        template = Affine(overview.sign, guess.offset) @ models.BoucWen(
            guess.k, a, 0.5 * held * (1.0 + guess.ratio), 0.5 * held * (1.0 - guess.ratio),
            guess.n, guess.h,
        )  # fmt: skip
        sides = [held, held] if apart else [held]
        theta = [guess.k, a, *sides, guess.ratio * held, *([guess.n] if free else []), guess.offset]
        fixed = template.parameters().values.copy()
        fixed[[_K, _A, _BETA, _GAMMA, _PHI, _OFFSET]] = 0.0
        if free:
            fixed[_N] = 0.0
        transform = np.zeros((fixed.size, len(theta)))
        transform[_K, 0] = transform[_A, 1] = transform[_OFFSET, -1] = 1.0
        if apart:
            transform[[_BETA, _GAMMA], 2:4] = 0.25
            transform[_PHI, 2:4] = 0.25, -0.25
        else:
            transform[[_BETA, _GAMMA], 2] = 0.5
        place = 2 + len(sides)
        transform[[_BETA, _GAMMA], place] = 0.5, -0.5
        if free:
            transform[_N, place + 1] = 1.0
        # Unloading is at most 900 times steeper than z = 0, which the model can still compute.
        weakest = _WEAKEST * held
        low = [0.0, 1e-3 * a, *(len(sides) * [weakest]), 0.0]
        high = [np.inf, 1e3 * a, *(len(sides) * [np.inf]), 900.0 * weakest]
        parametrization = Parametrization(
            template,
            transform,
            fixed,
            np.array([*low, *([LEAST_SHAPE] if free else []), -np.inf]),
            np.array([*high, *([LARGEST_SHAPE] if free else []), np.inf]),
        )
        return parametrization, np.array(theta)

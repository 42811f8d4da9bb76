"""Rate-dependent Prandtl-Ishlinskii models, from records at several frequencies together.

    min  sum_p A_p sum_k (model[u_p](k) - y_p(k))^2

For given radii and rate coefficient the weights solve a non-negative linear least squares problem,
so first guesses come from a coarse grid over those two alone. S4 eqs. 42-45, whose zeta is the
spacing of the radii.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.families.family import Family, Start, Words
from hyst.identification.families.option import (
    AUTO,
    Option,
    as_numbers,
    choice,
    option,
    read_numbers,
    whole_number_or_auto,
)
from hyst.identification.families.plays import PLAY_TEXT, SIZES, radii_option
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.fit.parametrization import SMALLEST_SLOPE, Parametrization, unchanged
from hyst.identification.fit.problem import model_jacobian
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.operators import Affine, Composition
from hyst.signals import hysteresis_percent, reversals

Array = NDArray[np.float64]

EVEN, FREE, GIVEN = "even", "free", "given"
EQUAL, HYSTERESIS = "equal", "hysteresis"
MOST_PLAYS = 50

_SPANS = (0.3, 0.5, 0.7, 0.9)
"""Largest radius of first guesses, over the largest the records can show."""

_WIDENINGS = (0.0, 0.1, 0.25, 0.5, 0.9)
"""Widening at the fastest sample of first guesses, over the largest radius."""

_STARTS = 3

_ONE_FREQUENCY = 1.2
"""Half swings whose durations differ by less than this factor all belong to one frequency."""


def _as_record_weights(given: Any, name: str) -> str | tuple[float, ...]:
    if isinstance(given, str):
        if given in (EQUAL, HYSTERESIS):
            return given
        raise InputError(
            f"{name} is {given!r}; choose {EQUAL!r}, {HYSTERESIS!r} or a number a record"
        )
    what = f"positive numbers, one a record, or {EQUAL!r} or {HYSTERESIS!r}"
    return tuple(as_numbers(given, name, what, 0.0).tolist())


def _read_record_weights(text: str, name: str) -> Any:
    return read_numbers(text, name) if "," in text else text


@final
@dataclass(frozen=True)
class RateDependent(Family):
    """``y = sign (p0 u + sum p_i z_i) + offset``, thresholds ``r_i + beta |du/dt|``.

    Parameters
    ----------
    plays
        Number of plays, 1 to 50, or ``"auto"``: chosen by cross-validation.
    radii
        Shape (n,), input units: keep these radii at rest instead of finding them.
    spacing
        ``"even"``: ``r_i = zeta i``; ``"free"``: every radius for itself.
    record_weights
        A_p: ``"equal"``, which is best for noise of equal size; ``"hysteresis"``: the hysteresis
        percent of the record over that of the first one; or a number for each record.
    """

    name = "rdpi"
    words = Words(
        full_name="rate-dependent Prandtl-Ishlinskii model",
        equations=(
            "y(t) = {sign}P[u](t) + offset",
            "P[u](t) = p0 u(t) + \u03a3 p\u1d62 F\u1d68[u](t),  \u03c1 = r\u1d62 + \u03b2 |du/dt|",
        ),
        explanations=(
            PLAY_TEXT,
            "The faster the input moves, the wider the plays: \u03b2 (beta) is the growth of their "
            "radii with the rate of the input; the figure shows them at rest.",
        ),
    )
    methods = ("trajectory", "sample-exact", "explicit")
    depends_on_rate = True
    rate_between_samples = True
    explains = ("rate dependence", "dynamics")  # its output falls behind as the rate grows

    plays: Any = option(AUTO, whole_number_or_auto(1, MOST_PLAYS, "Number of plays."))
    radii: Any = option(None, radii_option(zero_too=True))
    spacing: Any = option(
        EVEN, choice((EVEN, FREE), "Radii even (multiples of the first) or free.")
    )
    record_weights: Any = option(
        EQUAL,
        Option(
            _as_record_weights,
            "equal, hysteresis, or a number a record, as 1,1.56,2.",
            _read_record_weights,
            "WEIGHTS",
        ),
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.radii is not None and self.plays not in (AUTO, len(self.radii)):
            raise InputError(
                f"plays is {self.plays} but {len(self.radii)} radii are given; leave out plays"
            )

    def suited(self, data: Data) -> tuple[Self, tuple[str, ...]]:
        """Refuse radii out of reach and a wrong number of weights; say if no rate shows."""
        if self.radii is not None and self.radii[-1] >= data.half_range:
            raise InputError(
                f"radii are {list(self.radii)}; give numbers from 0 to below "
                f"{data.half_range:.6g}, half the input range"
            )
        count = len(data.records)
        if not isinstance(self.record_weights, str) and (
            len(self.record_weights) != count or min(self.record_weights) <= 0.0
        ):
            raise InputError(
                f"record_weights are {list(self.record_weights)}; give {count} positive numbers, "
                "one a record"
            )
        return self, _frequency_note(data)

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with scaled radii."""
        if self.radii is None:
            return self
        return replace(self, radii=[r * input_scale for r in self.radii])

    def sizes(self) -> tuple[int, ...]:
        """Give the numbers of plays to compare."""
        if self.radii is not None:
            return (len(self.radii),)
        return SIZES if self.plays == AUTO else (self.plays,)

    def least_parameters(self, size: int) -> int:
        """Give the number of weights, radii, beta and the offset."""
        return size + self._radius_count(size) + 3

    def root_weights(self, data: Data) -> Array | None:
        """Give sqrt(A_p) at the samples of record p (S4 eq. 44)."""
        if self.record_weights == EQUAL:
            return None
        weights = self.record_weights
        if weights == HYSTERESIS:
            percent = np.array(
                [
                    hysteresis_percent(r.u[w], y)
                    for r, w, y in zip(data.records, data.windows(), data.outputs(), strict=True)
                ]
            )
            if percent[0] == 0.0:
                raise InputError("the first record shows no hysteresis; give record_weights")
            weights = percent / percent[0]
        return np.repeat(np.sqrt(np.asarray(weights)), data.lengths())

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best points of a grid over radii and beta, weights by least squares."""
        data = overview.data
        fastest = max(float(np.abs(np.diff(each.u)).max()) / each.dt for each in data.records)
        has_rate = not _frequency_note(data)
        parametrization = self._parametrize(overview, size, has_rate)
        guesses = [
            self._guess(overview, parametrization, radii, widening, fastest)
            for radii in self._radius_guesses(size, data.largest_radius)
            for widening in (_WIDENINGS if has_rate else (0.0,))
        ]
        guesses.sort(key=lambda each: each[0])
        return [(parametrization, theta) for _, theta in guesses[:_STARTS]]

    def _radius_count(self, size: int) -> int:
        """How many parameters say where the radii are."""
        return {EVEN: min(size, 1), FREE: size, GIVEN: 0}[self._spacing]

    @property
    def _spacing(self) -> str:
        return GIVEN if self.radii is not None else self.spacing

    def _radius_guesses(self, size: int, largest: float) -> list[Array]:
        if self.radii is not None:
            return [np.array(self.radii)]
        even = [share * largest * np.arange(1, size + 1) / size for share in _SPANS]
        if self.spacing == EVEN:
            return even
        return even + [each**2 / each[-1] for each in even if size > 1]

    def _parametrize(self, overview: Overview, n: int, has_rate: bool) -> Parametrization:
        """Lay out theta = (p0, p_1 .. p_n, spacing or radii or nothing, beta, offset)."""
        m, largest = self._radius_count(n), overview.data.largest_radius
        radii = np.array(self.radii) if self.radii is not None else np.arange(1.0, n + 1.0)
        plays = RateDependentPrandtlIshlinskii(
            np.zeros(n), radii, 0.0, overview.data.records[0].dt, overview.mean_slope
        )
        spread = np.arange(1.0, n + 1.0)[:, None] if self._spacing == EVEN else np.eye(n)
        transform = np.zeros((2 * n + 4, n + m + 3))
        transform[: n + 1, : n + 1] = np.eye(n + 1)
        transform[n + 1 : 2 * n + 1, n + 1 : n + 1 + m] = spread[:, :m]
        transform[2 * n + 1, n + m + 1] = transform[-1, -1] = 1.0
        fixed = np.zeros(2 * n + 4)
        fixed[-2] = overview.sign
        if self._spacing == GIVEN:
            fixed[n + 1 : 2 * n + 1] = radii
        lower, upper = np.zeros(n + m + 3), np.full(n + m + 3, np.inf)
        lower[0] = SMALLEST_SLOPE * overview.mean_slope
        lower[n + 1 : n + 1 + m] = 1e-3 * largest
        lower[-1] = -np.inf
        upper[n + 1 : n + 1 + m] = largest / n if self._spacing == EVEN else largest
        upper[n + m + 1] = np.inf if has_rate else 0.0
        return Parametrization(
            Composition((plays, Affine(overview.sign, 0.0))),
            transform,
            fixed,
            lower,
            upper,
            _sorted_plays(n) if self._spacing == FREE else unchanged,
        )

    def _guess(
        self,
        overview: Overview,
        parametrization: Parametrization,
        radii: Array,
        widening: float,
        fastest: float,
    ) -> tuple[float, Array]:
        """Residual norm and theta for given radii, and widening at the fastest sample."""
        data, n = overview.data, radii.size
        beta = widening * data.largest_radius / fastest
        root = self.root_weights(data)
        root = np.ones(data.measured().size) if root is None else root
        bank = RateDependentPrandtlIshlinskii(np.zeros(n), radii, beta, data.records[0].dt)
        # The derivative by p0 and p is the input and the play outputs.
        columns = overview.sign * model_jacobian(data, bank)[:, : n + 1] * root[:, None]
        matrix = np.column_stack([columns, root, -root])
        weights, miss = non_negative(matrix, root * data.measured())
        # A weight that starts on its bound would give its radius no derivative.
        slopes = np.maximum(weights[: n + 1], 0.01 * overview.mean_slope)
        places = radii[: self._radius_count(n)]
        return miss, np.concatenate([slopes, places, [beta, float(weights[-2] - weights[-1])]])


def _sorted_plays(n: int) -> Any:
    """Give what sorts the plays by radius, each with its weight: their order means nothing."""

    def canonical(theta: Array) -> Array:
        order = np.argsort(theta[n + 1 : 2 * n + 1], kind="stable")
        result = theta.copy()
        result[1 : n + 1] = theta[1 : n + 1][order]
        result[n + 1 : 2 * n + 1] = theta[n + 1 : 2 * n + 1][order]
        return result

    return canonical


def _frequency_note(data: Data) -> tuple[str, ...]:
    """Say what it means if the records hold one frequency only; nothing if they hold more."""
    durations = np.concatenate(
        [r.dt * np.diff(reversals(r.u, 0.05 * float(np.ptp(r.u)))) for r in data.records]
    )
    if durations.size and durations.max() > _ONE_FREQUENCY * durations.min():
        return ()
    frequency = 0.5 / float(np.median(durations)) if durations.size else 0.0
    return (
        f"all records turn at one frequency, {frequency:.4g} Hz: beta and a linear lag cannot be "
        "told apart; beta was left at 0, so the model holds at that frequency only; add records at "
        "other frequencies",
    )

"""Rate-dependent Prandtl-Ishlinskii models, from records at several frequencies together.

    min  sum_p A_p sum_k (model[u_p](k) - y_p(k))^2

For given radii and rate coefficient the weights solve a non-negative linear least squares problem,
so first guesses come from a coarse grid over those two alone. S4 eqs. 42-45, whose zeta is the
spacing of the radii.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.mapped_plays import KNOTS_OPTION
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
from hyst.identification.families.rate_dependent_layout import (
    DEAD_ZONE,
    ENVELOPE,
    EVEN,
    FREE,
    GIVEN,
    NO_MAP,
    RateDependentLayout,
)
from hyst.identification.families.rate_law import (
    LAWS,
    LINEAR,
    MOST_PIECES,
    PIECEWISE,
    SATURATING,
    RateLaw,
    bends_to_try,
    first_constants,
    forms_of,
    law_for,
)
from hyst.identification.families.rate_law_choice import (
    layout_of,
    simplest_law,
    solved,
    with_law,
)
from hyst.identification.families.rate_law_told import (
    law_that_does_not_fit,
    notes_of_law,
    with_constants_of_law,
)
from hyst.identification.fit.bounded_least_squares import Solution
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.fit.problem import model_jacobian
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.signals import hysteresis_percent, reversals

if TYPE_CHECKING:
    from hyst.identification.result.identified import Identified

Array = NDArray[np.float64]

EQUAL, HYSTERESIS = "equal", "hysteresis"
MOST_PLAYS = 50

_SPANS = (0.3, 0.5, 0.7, 0.9)
"""Largest radius of first guesses, over the largest the records can show."""

_WIDENINGS = (0.0, 0.1, 0.25, 0.5, 0.9)
"""Widening at the fastest sample of first guesses, over the largest radius."""

_PLAYS_FOR_THE_LAW = 6
"""Evenly spaced, with which a law is chosen before their number is known."""

_ITERATIONS_FOR_THE_LAW = 40

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
    rate
        How the radii grow with the rate x: ``"linear"``: ``beta x``; ``"sqrt"``: ``c sqrt(x)``;
        ``"saturating"``: ``a x / (1 + x / b)`` or ``a b (1 - exp(-x / b))``, whichever fits better;
        ``"piecewise"``: straight between rates that the records hold; or ``"auto"``: the simplest
        of these that is not worse.
    map
        ``"none"``; ``"dead-zone"``: a piecewise linear map after the plays (S4 sec. III-D);
        ``"envelope"``: one before them, of whose output the rate is taken.
    knots
        Number of knots of the map, 1 to 50, evenly spaced over the signal it acts on; of an
        envelope also their places, input units.
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
    rate: Any = option(
        LINEAR, choice((*LAWS, AUTO), "How radii grow with the rate.", typed="rate-law")
    )
    map: Any = option(
        NO_MAP,
        choice((NO_MAP, DEAD_ZONE, ENVELOPE), "A map after the plays, before them, or none."),
    )
    knots: Any = option(6, KNOTS_OPTION)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.radii is not None and self.plays not in (AUTO, len(self.radii)):
            raise InputError(
                f"plays is {self.plays} but {len(self.radii)} radii are given; leave out plays"
            )
        if self.map != ENVELOPE and not isinstance(self.knots, int):
            raise InputError(
                f"knots are {list(self.knots)}; give their number, for only the places of an "
                "envelope's knots are known before the fit"
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
        """Give the family with scaled radii and knots."""
        given: dict[str, Any] = {}
        if self.radii is not None:
            given["radii"] = [r * input_scale for r in self.radii]
        if not isinstance(self.knots, int):
            given["knots"] = [each * input_scale for each in self.knots]
        return replace(self, **given) if given else self

    def sizes(self) -> tuple[int, ...]:
        """Give the numbers of plays to compare."""
        if self.radii is not None:
            return (len(self.radii),)
        return SIZES if self.plays == AUTO else (self.plays,)

    def least_parameters(self, size: int) -> int:
        """Give the number of weights, radii, constants of law and map, and the offset."""
        of_law = {SATURATING: 2, PIECEWISE: MOST_PIECES}.get(self.rate, 1)
        return size + self._radius_count(size) + of_law + self._knot_count + 2

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
        """Give the best points of a grid over radii and widening, weights by least squares."""
        if not self._shows_rate(overview.data):
            laws = [law_for(LINEAR, "", overview.data)]
        elif self.rate == AUTO:
            key = ("rate law", self)
            name, form = overview.once(key, lambda: self._first_choice(overview))
            laws = [law_for(name, form, overview.data)]
        else:
            laws = self._laws(overview.data)
        guesses = [each for law in laws for each in self._guesses(overview, size, law)]
        guesses.sort(key=lambda each: each.miss)
        return [self._start_from(overview, each) for each in guesses[:_STARTS]]

    def finish(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Renew the tangent of the law; choose the law once more where it is open."""
        layout = layout_of(fit)
        if not layout.has_rate or layout.size != fit.solution.theta.size:  # dynamics come after
            return fit
        fit = solved(fit, overview, fit.solution.theta, max_iterations)
        own = layout_of(fit).law
        fits = [
            fit
            if (law.name, law.form) == (own.name, own.form)
            else with_law(fit, law, overview, max_iterations)
            for law in self._laws(overview.data)
        ]
        return simplest_law(fits, overview) if len(fits) > 1 else fit

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants that are free; of a law its own and not those of its table."""
        return with_constants_of_law(super().estimates(fit), fit)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what a law is worth, and where it does not fit."""
        return notes_of_law(fit)

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Say where the law does not fit."""
        told = law_that_does_not_fit(fit, overview.data, self.root_weights(overview.data))
        return replace(identified, undetermined=(*identified.undetermined, *told))

    def _shows_rate(self, data: Data) -> bool:
        return not _frequency_note(data)

    def _laws(self, data: Data) -> list[RateLaw]:
        """Give the laws that the option allows, from the simplest to the richest."""
        names = LAWS if self.rate == AUTO else (self.rate,)
        return [law_for(name, form, data) for name in names for form in forms_of(name)]

    def _first_choice(self, overview: Overview) -> tuple[str, str]:
        """Choose a law with a fixed number of plays, evenly spaced."""
        size = self.sizes()[0] if len(self.sizes()) == 1 else _PLAYS_FOR_THE_LAW
        fits = []
        for law in self._laws(overview.data):
            guess = min(self._guesses(overview, size, law), key=lambda each: each.miss)
            parametrization, theta = self._start_from(overview, guess)
            unsolved = Fit(self, size, parametrization, Solution(theta, np.inf, 0, ""))
            fits.append(solved(unsolved, overview, theta, _ITERATIONS_FOR_THE_LAW))
        law = layout_of(simplest_law(fits, overview)).law
        return law.name, law.form

    def _radius_count(self, size: int) -> int:
        """How many parameters say where the radii are."""
        return {EVEN: min(size, 1), FREE: size, GIVEN: 0}[self._spacing]

    @property
    def _knot_count(self) -> int:
        if self.map == NO_MAP:
            return 0
        return self.knots if isinstance(self.knots, int) else len(self.knots)

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

    def _guesses(self, overview: Overview, size: int, law: RateLaw) -> list[_Guess]:
        has_rate = self._shows_rate(overview.data)
        widenings = _WIDENINGS if has_rate else (0.0,)
        return [
            self._guess(overview, radii, law, share, bend)
            for radii in self._radius_guesses(size, overview.data.largest_radius)
            for share in widenings
            for bend in (bends_to_try(law) if share > 0.0 else bends_to_try(law)[:1])
        ]

    def _guess(
        self, overview: Overview, radii: Array, law: RateLaw, share: float, bend: float
    ) -> _Guess:
        """Fit the weights for given radii and widening at the fastest sample."""
        data, n = overview.data, radii.size
        constants = first_constants(law, share * data.largest_radius, bend)
        law = law.renewed(constants) if law.renewed is not None else law
        root = self.root_weights(data)
        root = np.ones(data.measured().size) if root is None else root
        curve, dt = law.at(constants), data.records[0].dt
        bank = RateDependentPrandtlIshlinskii(np.zeros(n), radii, curve, dt)
        # The derivative by p0 and p is the input and the play outputs.
        columns = overview.sign * model_jacobian(data, bank)[:, : n + 1] * root[:, None]
        matrix = np.column_stack([columns, root, -root])
        weights, miss = non_negative(matrix, root * data.measured())
        # A weight that starts on its bound would give its radius no derivative.
        slopes = np.maximum(weights[: n + 1], 0.01 * overview.mean_slope)
        return _Guess(miss, slopes, radii, law, constants, float(weights[-2] - weights[-1]))

    def _start_from(self, overview: Overview, guess: _Guess) -> Start:
        layout = RateDependentLayout(
            guess.radii,
            self._spacing,
            guess.law,
            self.map,
            self._knots_over(overview, guess.offset),
            self._shows_rate(overview.data),
        )
        theta = layout.theta(guess.weights, guess.radii, guess.constants, guess.offset)
        return layout.parametrization(overview), theta

    def _knots_over(self, overview: Overview, offset: float) -> Array:
        """Spread the knots evenly over the signal that the map acts on, none at 0."""
        if self.map == NO_MAP:
            return np.empty(0)
        if not isinstance(self.knots, int):
            places = np.array(self.knots)
            return places[np.abs(places) > 1e-6 * 2.0 * overview.data.half_range]
        if self.map == ENVELOPE:
            records = overview.data.records
            low = min(float(each.u.min()) for each in records)
            high = max(float(each.u.max()) for each in records)
        else:
            signal = overview.sign * (overview.data.measured() - offset)
            low, high = float(signal.min()), float(signal.max())
        knots = np.linspace(low, high, self.knots + 2)[1:-1]
        return np.asarray(knots[np.abs(knots) > 1e-6 * (high - low)])


@dataclass(frozen=True, eq=False)
class _Guess:
    """Residual norm, weights with p0 first, radii, law with its constants, and offset."""

    miss: float
    weights: Array
    radii: Array
    law: RateLaw
    constants: Array
    offset: float


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

"""Rate-dependent Prandtl-Ishlinskii models, from records at several frequencies together.

    min  sum_p A_p sum_k (model[u_p](k) - y_p(k))^2

For given radii and rate coefficient the weights solve a non-negative linear least squares problem,
so first guesses come from a coarse grid over those two alone. S4 eqs. 42-45, whose zeta is the
spacing of the radii.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.families.drive_noise import errors_by_drives, told_of_drives
from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.mapped_plays import KNOTS_OPTION
from hyst.identification.families.option import (
    AUTO,
    choice,
    option,
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
    radius_count,
)
from hyst.identification.families.rate_dependent_options import (
    EQUAL,
    FILTER_OPTION,
    HYSTERESIS,
    NO_FILTER,
    RECORD_WEIGHTS_OPTION,
)
from hyst.identification.families.rate_dependent_rates import frequency_note, sample_times_note
from hyst.identification.families.rate_dependent_starts import FirstGuesses
from hyst.identification.families.rate_dependent_words import words_of
from hyst.identification.families.rate_law import (
    LAWS,
    LINEAR,
    MOST_PIECES,
    PIECEWISE,
    SATURATING,
    SQRT,
    RateLaw,
    forms_of,
    law_for,
)
from hyst.identification.families.rate_law_choice import (
    has_dynamics,
    layout_of,
    simplest_law,
    solved,
    with_law,
)
from hyst.identification.families.rate_law_told import (
    law_that_does_not_fit,
    loops_that_narrow,
    notes_of_law,
    with_constants_of_law,
)
from hyst.identification.fit.bounded_least_squares import Solution
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.smoothed_drive import (
    Smoother,
    driven_by,
    without_noise,
)
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.signals import Record, hysteresis_percent

if TYPE_CHECKING:
    from hyst.identification.result.identified import Identified

Array = NDArray[np.float64]

MOST_PLAYS = 50

_PLAYS_FOR_THE_LAW = 6
"""Evenly spaced, with which a law is chosen before their number is known."""

_ITERATIONS_FOR_THE_LAW = 25

_STARTS = 3


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
    map_knots
        Number of knots of the map, 1 to 50, evenly spaced over the signal it acts on; of an
        envelope also their places, input units.
    rate_filter
        What is done about noise of the measured drive, whose differences are no rates of the
        actuator: ``"auto"``: where there is some, it is smoothed out of the whole record, as
        strongly as cross-validation says; a time constant, s: of a low-pass without lag; or
        ``"none"``. The model has no filter: it is for the commanded drive.
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
    about_rates = (
        "Let the radii grow by another law of the rate (--rate-law auto), or use family "
        "hammerstein where there is a resonance."
    )
    rate_between_samples = True
    explains = ("rate dependence", "dynamics")  # its output falls behind as the rate grows

    plays: Any = option(AUTO, whole_number_or_auto(1, MOST_PLAYS, "Number of plays."))
    radii: Any = option(None, radii_option(zero_too=True))
    spacing: Any = option(
        EVEN, choice((EVEN, FREE), "Radii even (multiples of the first) or free.")
    )
    record_weights: Any = option(EQUAL, RECORD_WEIGHTS_OPTION)
    rate: Any = option(
        LINEAR, choice((*LAWS, AUTO), "How radii grow with the rate.", typed="rate-law")
    )
    map: Any = option(
        NO_MAP,
        choice((NO_MAP, DEAD_ZONE, ENVELOPE), "A map after the plays, before them, or none."),
    )
    map_knots: Any = option(6, KNOTS_OPTION)
    rate_filter: Any = option(AUTO, FILTER_OPTION)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.radii is not None and self.plays not in (AUTO, len(self.radii)):
            raise InputError(
                f"plays is {self.plays} but {len(self.radii)} radii are given; leave out plays"
            )
        if self.map != ENVELOPE and not isinstance(self.map_knots, int):
            raise InputError(
                f"map_knots are {list(self.map_knots)}; give their number, for only the places of "
                "an envelope's knots are known before the fit"
            )

    def refused_before_dynamics(self) -> str:
        """Refuse laws that more than scale, and a filter of the drive."""
        if self.rate in (SATURATING, AUTO):
            return (
                f"rate is {self.rate!r}, but before dynamics only laws that one or more factors "
                f"scale are identified; give {LINEAR!r}, {SQRT!r} or {PIECEWISE!r}"
            )
        if not isinstance(self.rate_filter, str):
            return (
                f"rate_filter is {self.rate_filter} s, but before dynamics the drive is taken as "
                "it is; leave out rate_filter, or smooth the drive of the records"
            )
        return ""

    def records_to_use(
        self, records: tuple[Record, ...], start: Literal["auto"] | int
    ) -> tuple[Data, tuple[str, ...]]:
        """Take the noise out of measured drives, and say so."""
        smoothers = tuple(self._smoother(each) for each in records)
        if not any(smoothers):
            return prepare(records, start), ()
        smooth = tuple(map(driven_by, records, smoothers))
        return replace(prepare(smooth, start), smoothers=smoothers), told_of_drives(smoothers)

    def _smoother(self, record: Record) -> Smoother | None:
        if self.rate_filter == NO_FILTER:
            return None
        return without_noise(record, None if self.rate_filter == AUTO else self.rate_filter)

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
        return self, frequency_note(data) + sample_times_note(data)

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with scaled radii and knots."""
        given: dict[str, Any] = {}
        if self.radii is not None:
            given["radii"] = [r * input_scale for r in self.radii]
        if not isinstance(self.map_knots, int):
            given["map_knots"] = [each * input_scale for each in self.map_knots]
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
        return np.repeat(np.sqrt(self._record_weights(data)), data.lengths())

    def _record_weights(self, data: Data) -> Array:
        """Give A_p, one a record (S4 eq. 45)."""
        if self.record_weights != HYSTERESIS:
            return np.asarray(self.record_weights)
        percent = np.array(
            [
                hysteresis_percent(r.u[w], y)
                for r, w, y in zip(data.records, data.windows(), data.outputs(), strict=True)
            ]
        )
        if percent[0] == 0.0:
            raise InputError("the first record shows no hysteresis; give record_weights")
        return np.asarray(percent / percent[0])

    def _told_weights(self, data: Data) -> tuple[str, ...]:
        if self.record_weights != HYSTERESIS:
            return ()
        weights = ", ".join(f"{each:.3g}" for each in self._record_weights(data))
        return (f"the records weigh {weights}: their hysteresis percent over that of the first",)

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
        return self._first_guesses(overview).best(size, laws, _STARTS)

    def renewed(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Renew the tangent of the law."""
        if layout_of(fit).law.renewed is None or has_dynamics(fit):
            return fit
        return solved(fit, overview, fit.solution.theta, max_iterations)

    def finish(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Renew the tangent of the law; choose the law once more where it is open."""
        if not layout_of(fit).has_rate or has_dynamics(fit):
            return fit
        fit = solved(fit, overview, fit.solution.theta, max_iterations)
        own = layout_of(fit).law
        fits = [
            fit
            if (law.name, law.form) == (own.name, own.form)
            else with_law(fit, law, overview, min(max_iterations, _ITERATIONS_FOR_THE_LAW))
            for law in self._laws(overview.data)
        ]
        chosen = simplest_law(fits, overview) if len(fits) > 1 else fit
        if chosen is fit:
            return fit
        return solved(chosen, overview, chosen.solution.theta, max_iterations)

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants that are free; of a law its own and not those of its table."""
        return with_constants_of_law(super().estimates(fit), fit)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say which law was found, and what the records weigh."""
        return notes_of_law(fit) + self._told_weights(data)

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Say where the law does not fit, and count the drive's noise in the standard errors."""
        data, root = overview.data, self.root_weights(overview.data)
        by_drives = errors_by_drives(fit, data, root)
        errors = identified.standard_errors.copy()
        # Constants of further stages come last.
        errors[: by_drives.size] = np.hypot(errors[: by_drives.size], by_drives)
        whole = len(fit.operator.parameters()) == len(identified.model.parameters())
        told = law_that_does_not_fit(fit, data, root) if whole else ()
        if whole and not told:
            told = loops_that_narrow(fit, identified.diagnosis)
        return replace(
            identified,
            undetermined=(*identified.undetermined, *told),
            standard_errors=errors,
        )

    def words_for(self, identified: Identified) -> Words:
        """Give the words for the law and the map that were found."""
        return words_of(self.words, identified.model)

    def _shows_rate(self, data: Data) -> bool:
        return not frequency_note(data)

    def _laws(self, data: Data) -> list[RateLaw]:
        """Give the laws that the option allows, from the simplest to the richest."""
        names = LAWS if self.rate == AUTO else (self.rate,)
        return [law_for(name, form, data) for name in names for form in forms_of(name)]

    def _first_choice(self, overview: Overview) -> tuple[str, str]:
        """Choose a law with a fixed number of plays, evenly spaced."""
        size = self.sizes()[0] if len(self.sizes()) == 1 else _PLAYS_FOR_THE_LAW
        fits, guesses = [], self._first_guesses(overview)
        for law in self._laws(overview.data):
            [(parametrization, theta)] = guesses.best(size, [law], 1)
            unsolved = Fit(self, size, parametrization, Solution(theta, np.inf, 0, ""))
            fits.append(solved(unsolved, overview, theta, _ITERATIONS_FOR_THE_LAW))
        law = layout_of(simplest_law(fits, overview)).law
        return law.name, law.form

    def _radius_count(self, size: int) -> int:
        return radius_count(self._spacing, size)

    @property
    def _knot_count(self) -> int:
        if self.map == NO_MAP:
            return 0
        return self.map_knots if isinstance(self.map_knots, int) else len(self.map_knots)

    @property
    def _spacing(self) -> str:
        return GIVEN if self.radii is not None else self.spacing

    def _first_guesses(self, overview: Overview) -> FirstGuesses:
        return FirstGuesses(
            overview,
            self._spacing,
            self.radii,
            self.map,
            self.map_knots,
            self._shows_rate(overview.data),
            self.root_weights(overview.data),
        )

"""Hysteresis, then linear dynamics: a family made around any other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.choice.cross_validation import leaves_white_noise
from hyst.identification.families.family import Estimates, Family, Fit, Start, Words
from hyst.identification.families.hammerstein import options
from hyst.identification.families.hammerstein.coefficients import estimates_with_dynamics
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import (
    as_whole_delay,
    shortened,
    signal_behind,
)
from hyst.identification.families.hammerstein.impulse_response.first_guess import (
    FirstDynamics,
    first_dynamics,
    fronts_of,
)
from hyst.identification.families.hammerstein.impulse_response.markov import choose_markov
from hyst.identification.families.hammerstein.joint import dynamics_of, joint, joint_of
from hyst.identification.families.hammerstein.known.creeping_front import (
    CreepingFront,
    as_creeping,
    joined,
    told_of_creep,
)
from hyst.identification.families.hammerstein.known.given_dynamics import (
    GivenDynamics,
)
from hyst.identification.families.hammerstein.known.held_doubts import doubts_about_given
from hyst.identification.families.hammerstein.known.held_front import (
    DEFAULT,
    HeldFront,
    require_one_hysteresis,
    told_of,
)
from hyst.identification.families.hammerstein.known.known_front import behind_known
from hyst.identification.families.hammerstein.known.known_start import settled, told_of_delay
from hyst.identification.families.hammerstein.known.known_starts import known_starts
from hyst.identification.families.hammerstein.large_level import (
    at_level,
    raised_by,
    told_of_level,
    without_large_level,
)
from hyst.identification.families.hammerstein.record_checks import (
    flat_tops,
    require_samples,
)
from hyst.identification.families.hammerstein.start.first_guess_of_plays import (
    Wanted,
    first_dynamics_of_plays,
)
from hyst.identification.families.hammerstein.start.ringing import without_ringing
from hyst.identification.families.hammerstein.start.settled_fit import with_settled_dynamics
from hyst.identification.families.hammerstein.start.spread_stretches import spread
from hyst.identification.families.hammerstein.told.distortion_levels import average_periods
from hyst.identification.families.hammerstein.told.identified_hammerstein import (
    IdentifiedHammerstein,
)
from hyst.identification.families.hammerstein.told.result import identified_with_dynamics
from hyst.identification.families.hammerstein.told.without_dynamics import dynamics_doubts
from hyst.identification.families.hammerstein.told.words import WORDS, words_behind
from hyst.identification.families.linear import Linear
from hyst.identification.families.option import (
    AUTO,
    option,
)
from hyst.identification.fit.bounded_least_squares import CONVERGED, Problem, Solution, minimize
from hyst.identification.record_use.one_sample_time import at_one_sample_time, finest
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.thinning import MOST_SAMPLES
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import Identified
from hyst.models import LinearDynamics
from hyst.signals import Record

Array = NDArray[np.float64]

MOST_FITTED = 300_000
"""Samples whose Jacobian is held in memory; longer records are fitted to in stretches."""

MOST_SEARCHED, SHARE = 60_000, 10
"""Samples at most, and what part of the record, in which order and size are searched."""

_WARM_UP = 8_000
_BURST = 12
_STALLED = 0.998
_TOLERANCE = 2e-2  # of the residual variance: at most a seventh of a standard error is left


@final
@dataclass(frozen=True)
class Hammerstein(Family):
    """``y = G[v], v = H[u]``: a hysteresis H of any family, then linear dynamics G.

    Parameters
    ----------
    hysteresis
        Name of the family in front, or a family of ``hyst.families`` with its options. Options of a
        family given by name may stand beside it, as
        ``identify(record, family="hammerstein", hysteresis="gpi", plays=4)``.
    fir_order
        ``"auto"``: the fit starts from plays on a grid of radii with dynamics behind them. A
        number, 1 to 5000: from an impulse response up to that lag, the paper's method, which the
        drive must excite up to half the sample rate.
    state_order
        Number of states of G, 1 to 64, or ``"auto"``: up to 12, as many as lower the error by more
        than their numbers cost.
    period
        Samples of a period of the drive: all but the first are averaged. None: there is none.
    dynamics
        G where it is known, which is held at a gain of 1 at rest: a ``LinearDynamics``, a model
        with it at its output, a system of python-control or scipy.signal (continuous ones with
        their input held between samples), or a frequency response, to which dynamics are fitted
        first (``hyst.read_frequency_response``). The drive need not excite it then. None: it is
        identified.
    front
        The hysteresis where it is known, which is held but for a gain and an offset after it: an
        operator, a result of ``hyst.identify``, or a model that ``hyst.load`` read. None: it is
        identified.
    """

    name = "hammerstein"
    words = WORDS
    methods = ("exact", "noncausal")
    judged_in_sample = True
    answers_late = True
    depends_on_rate = True
    explains = ("rate dependence", "dynamics")
    wraps = "hysteresis"

    hysteresis: Any = option(DEFAULT, options.HYSTERESIS)
    fir_order: Any = option(AUTO, options.FIR_ORDER)
    state_order: Any = option(AUTO, options.STATE_ORDER)
    period: Any = option(None, options.PERIOD)
    dynamics: Any = option(None, options.DYNAMICS)
    front: Any = option(None, options.FRONT)

    def __post_init__(self) -> None:
        """Check the options, and that a hysteresis is not given and asked for."""
        super().__post_init__()
        require_one_hysteresis(self.front, self.hysteresis)

    @classmethod
    def can_wrap(cls, other: type[Family]) -> bool:
        """Tell whether a family can be in front: one whose output is not late itself."""
        return not other.answers_late

    @property
    def hysteresis_family(self) -> Family:
        """The hysteresis; the one that is given, if one is."""
        if self.front is not None:
            given: HeldFront = self.front
            return as_creeping(replace(given, lags=0), given.lags) if given.lags else given
        assert isinstance(self.hysteresis, Family), "the registry puts an object for a name"
        return self.hysteresis

    def creeping(self, lags: int) -> Self:
        """Give the family with so many lags of creep between hysteresis and dynamics."""
        if self.front is not None:
            return replace(self, front=replace(self.front, lags=lags))
        return replace(self, hysteresis=as_creeping(self.hysteresis_family, lags))

    def records_to_use(
        self, records: tuple[Record, ...], start: Literal["auto"] | int
    ) -> tuple[Data, tuple[str, ...]]:
        """Average periods; leave out what the unknown state of the dynamics may have disturbed."""
        refused = self.hysteresis_family.refused_before_dynamics()
        if refused:
            raise InputError(refused)
        if self.period is not None:
            if start != AUTO:
                raise InputError(
                    f"start is {start!r} and period {self.period!r}; leave out start, it is known"
                )
            records = tuple(average_periods(each, self.period) for each in records)
            # The first of two equal periods is the past of the second, of both parts.
            start = int(self.period)
        at_one = at_one_sample_time(records, None if self.dynamics is None else self.dynamics.dt)
        data = at_one.prepared(start)
        if self.front is None and not isinstance(self.hysteresis_family, CreepingFront):
            data = without_large_level(data)
        require_samples(data)
        doubts = at_one.notes + flat_tops(records) + told_of_level(data)
        if self.dynamics is not None:
            dt = data.records[0].dt
            data = settled(data, self.dynamics.at(dt)) if start == AUTO else data
            return data, doubts + self.dynamics.told(dt) + told_of(self.front)
        if not self.starts_from_plays:
            seen = finest(Overview(data)).data
            seen = seen if self.front is None else self.front.behind(seen)
            doubts += choose_markov(seen.records, self.fir_order)[1]
        return data, doubts + told_of(self.front)

    @property
    def starts_from_plays(self) -> bool:
        """Whether plays are the first guess of the hysteresis; else the paper's first step is."""
        return bool(self.fir_order == AUTO)

    def suited(self, data: Data) -> tuple[Self, tuple[str, ...]]:
        """Fit the options of the hysteresis to the records."""
        if self.front is not None:
            return self, ()
        front, notes = self.hysteresis_family.suited(data)
        return replace(self, hysteresis=front), notes

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with options of the hysteresis in other units."""
        if self.front is not None:
            return replace(self, front=self.front.in_units(input_scale, output_scale))
        return replace(self, hysteresis=self.hysteresis_family.in_units(input_scale, output_scale))

    def searched(self, data: Data) -> Data:
        """Give stretches of long records, from all over them."""
        samples = sum(len(each) for each in data.records)
        return spread(data, int(np.clip(samples // SHARE, MOST_SAMPLES, MOST_SEARCHED)))

    def fitted(self, data: Data) -> Data:
        """Give as many samples as memory allows, from all over the records."""
        return spread(data, MOST_FITTED)

    def sizes(self) -> tuple[int, ...]:
        """Give the sizes of the hysteresis."""
        return self.hysteresis_family.sizes()

    def least_parameters(self, size: int) -> int:
        """Give those of the hysteresis and of dynamics of the least order without feedthrough."""
        if self.dynamics is not None:
            return self.hysteresis_family.least_parameters(size)
        order = 1 if self.state_order == AUTO else int(self.state_order)
        return self.hysteresis_family.least_parameters(size) + 2 * order - 1

    def root_weights(self, data: Data) -> Array | None:
        """Give the weights of the hysteresis' family."""
        return self.hysteresis_family.root_weights(data)

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Start from the dynamics found once, and the hysteresis before them of this size."""
        whole = _finest(overview)
        known = overview.once(
            ("known", self, size),
            lambda: known_starts(
                (self.front, self.dynamics),
                self.hysteresis_family,
                overview,
                size,
                lambda front: self._dynamics_behind(whole, front),
            ),
        )
        if known is not None:
            return known[:most]
        first = self._first_dynamics(whole)
        fronts = overview.once(
            ("fronts", self, size),
            lambda: fronts_of(self, self.hysteresis_family, first, overview.data, size),
        )
        return [joint(each, first.dynamics) for each in fronts[:most]]

    def _first_dynamics(self, overview: Overview) -> FirstDynamics:
        return overview.once(
            ("first dynamics", self), lambda: self._find_dynamics(overview, self.front)
        )

    def _dynamics_behind(self, overview: Overview, front: HeldFront | None) -> LinearDynamics:
        if front is None or front is self.front or not self.starts_from_plays:
            return self._first_dynamics(overview).dynamics
        return overview.once(
            ("dynamics behind", self), lambda: self._find_dynamics(overview, front).dynamics
        )

    def _find_dynamics(self, overview: Overview, known: HeldFront | None) -> FirstDynamics:
        if self.starts_from_plays:
            wanted = Wanted(self.state_order, self._wanted_delay(overview), known)
            return first_dynamics_of_plays(overview, wanted)
        orders = (self.fir_order, self.state_order)
        front = self.hysteresis_family if self.front is None else Linear()
        front = front.base if isinstance(front, CreepingFront) else front
        return first_dynamics(self, front, behind_known(self.front, overview), orders)

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = _TOLERANCE
    ) -> Solution:
        """Minimise the simulated output error over hysteresis and dynamics.

        A hysteresis richer or poorer than the actuator's leaves a long flat valley. So it has
        converged, too, when a dozen steps lower the squared error by no more than a hundredth.
        """
        before, used = np.inf, 0
        problem, theta, back = self.hysteresis_family.in_own_coordinates(problem, theta)
        while True:
            found = minimize(problem, theta, min(_BURST, max(max_iterations - used, 1)), tolerance)
            used += found.iterations
            if found.status == CONVERGED or found.cost > _STALLED * before:
                return Solution(back(found.theta), found.cost, used, CONVERGED)
            if used >= max_iterations:
                return replace(found, theta=back(found.theta), iterations=used)
            theta, before = found.theta, found.cost

    def finish(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Settle the dynamics; improve the hysteresis as its own family knows, they following."""
        fit = self._with_settled_dynamics(fit, overview, max_iterations)
        seen = replace(
            fit, family=self.hysteresis_family, parametrization=joint_of(fit).seen_by_front()
        )
        if self.starts_from_plays and leaves_white_noise(overview, fit):
            return fit
        short = Overview(shortened(overview.data, _WARM_UP), rates_matter=True)
        improved = self.hysteresis_family.finish(seen, short, _BURST)
        if np.array_equal(improved.solution.theta, fit.solution.theta):
            return fit
        problem = fit.problem(overview.data)
        again = self.solve(problem, improved.solution.theta, max_iterations)
        return replace(fit, solution=again) if again.cost < fit.solution.cost else fit

    def _with_settled_dynamics(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Look at delay, order and feedthrough again, behind the hysteresis that was found."""
        if not self.starts_from_plays or joint_of(fit).held:
            return fit
        whole = _finest(overview)
        wanted = Wanted(self.state_order, self._wanted_delay(overview))
        creeps = isinstance(self.hysteresis_family, CreepingFront)  # whose poles are slow
        plays = None if creeps else self._first_dynamics(whole).cost
        return with_settled_dynamics(
            fit, (overview.data, whole.data), wanted, plays, max_iterations
        )

    def _wanted_delay(self, overview: Overview) -> int | None:
        return None if overview.delay == AUTO else as_whole_delay(overview.delay)

    def simplified(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Fit again without the parts of the hysteresis that came out idle."""
        dynamics, before = dynamics_of(fit), self._front_fit(fit)
        behind = Overview(signal_behind(overview.data, dynamics), rates_matter=True)
        simpler = self.hysteresis_family.simplified(before, behind, max_iterations)
        if simpler is before:
            return fit
        start = simpler.parametrization, simpler.solution.theta
        parametrization, theta = joined(start, dynamics, joint_of(fit).held)
        family = replace(self, hysteresis=simpler.family)  # which may have fewer terms, too
        left = replace(fit, family=family, parametrization=parametrization)
        problem = left.problem(overview.data)
        solution = self.solve(problem, theta, max_iterations)
        # Where the signal behind it is hardly seen, a new fit may end elsewhere, and worse.
        as_good = solution.cost * _STALLED <= max(fit.solution.cost, problem.negligible)
        return replace(left, solution=solution) if as_good else fit

    def _front_fit(self, fit: Fit) -> Fit:
        """Give the hysteresis of a fit as a fit of its own family."""
        front = joint_of(fit).front
        solution = replace(fit.solution, theta=fit.solution.theta[: front.size])
        return Fit(self.hysteresis_family, fit.size, front, solution)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what the hysteresis' family says, and if the dynamics explain nothing."""
        notes = self.hysteresis_family.notes(self._front_fit(fit), data)
        if isinstance(self.hysteresis_family, CreepingFront):
            notes += told_of_creep(fit, data)
        if joint_of(fit).held:
            given: GivenDynamics = self.dynamics
            notes += told_of_delay(given, dynamics_of(fit), data)
            return notes + doubts_about_given(fit, self.fitted(data))
        return notes + dynamics_doubts(fit, self.hysteresis_family, self.fitted(data))

    def estimates(self, fit: Fit) -> Estimates:
        """Give constants of the hysteresis and coefficients of the dynamics."""
        front = self.hysteresis_family.estimates(self._front_fit(fit))
        return estimates_with_dynamics(front, joint_of(fit), dynamics_of(fit))

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Add the parts, the impulse response, the poles and the loop."""
        found = identified_with_dynamics(
            identified, fit, self.hysteresis_family, finest(overview), self.fir_order
        )
        level = overview.data.level
        return (
            at_level(found, raised_by(fit, joint_of(fit).front, level), level) if level else found
        )

    def without_past(self, fit: Fit, data: Data) -> Data:
        """Take out what the unknown state of the dynamics before each record left in it."""
        return without_ringing(data, fit)

    def words_for(self, identified: Identified) -> Words:
        """Give the words of the hysteresis and of the dynamics behind it."""
        if not isinstance(identified, IdentifiedHammerstein):
            return self.words
        return words_behind(identified.front.words)


def _finest(overview: Overview) -> Overview:
    return overview.once("finest", lambda: finest(overview))

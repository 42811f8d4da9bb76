"""A first-order lag of the drive as a stage of the model that a search has found without it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.choice.joint_delay import BETWEEN_SAMPLES
from hyst.identification.families.family import Family, Fit
from hyst.identification.families.option import AUTO
from hyst.identification.fit.stages import with_stage
from hyst.identification.judgement.judge import level_of
from hyst.identification.judgement.regression import correlation_time
from hyst.identification.lag.lagging_family import LaggingFamily, behind_lag
from hyst.identification.options import Options
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.lateness import lateness_of
from hyst.identification.search import Found
from hyst.models import Lag
from hyst.signals import Record

Array = NDArray[np.float64]
Wanted = float | Literal["auto"] | None
Search = Callable[[Cleaned, Options], Found]

FAR = 20.0
"""Variance ratio of one constant: noise reaches it once in a hundred thousand times."""

SHORTEST, LONGEST = 1e-3, 20.0
"""Of a time constant that is looked for: samples, and times the delay seen first."""

ROUNDS = 6
SHARES = (0.25, 0.5, 1.0)
"""Of the longest delay possible: time constants to search with where nothing describes the records
without a lag."""

SETTLED = 0.05
"""Samples: a change of the delay beside a lag that is worth no further round."""

TWO = 2.0


def as_lag(lag: Any) -> Wanted:
    """Check what is to be done about a lag.

    Parameters
    ----------
    lag
        ``"auto"``, a time constant in seconds, or None.

    Raises
    ------
    InputError
        If it is something else.
    """
    if lag is None or (isinstance(lag, str) and lag == AUTO):
        return lag  # type: ignore[return-value]
    number = isinstance(lag, int | float | np.number) and not isinstance(lag, bool)
    if not number or not (math.isfinite(lag) and lag > 0.0):
        raise InputError(
            f"lag is {lag!r}; give 'auto', a time constant in seconds, above 0, or None for none"
        )
    return float(lag)


def found_with_lag(
    search: Search,
    records: Cleaned,
    wanted: Wanted,
    options: Options,
    families: Sequence[Family] = (),
) -> Found:
    """Search, and give the model the lag that is asked for.

    A time constant that is given is held: everything is chosen for the drive as it comes out of
    the lag. ``"auto"``: what the search takes for a delay is fitted as a lag, as a delay and as
    both, and what leaves least is taken.

    Parameters
    ----------
    search
        Identifies without a lag.
    records
        What from.
    wanted
        As of ``identify``.
    options
        What the user wants.
    families
        That are named.

    Raises
    ------
    InputError
        If a time constant is no lag of records of their sample times.
    NotIdentifiableError
        If the family has dynamics of its own.
    """
    if wanted is None:
        return search(records, options)
    if isinstance(wanted, float):
        _require_place(families)
        found = search(_lagged(records, wanted), options)
        return _held(found, records.records, wanted)
    found = search(records, options)
    if found.fit.family.answers_late:
        return found
    options.say("lag")
    work = _Work.of(found, options)
    return work.told(work.from_guesses(search, records))


def _lagged(records: Cleaned, time_constant: float) -> Cleaned:
    """Give records whose drive is what comes out of a lag."""
    lagged = [replace(each, u=Lag(time_constant, each.dt)(each.u)) for each in records.records]
    return replace(records, records=tuple(lagged))


def _require_place(families: Sequence[Family]) -> None:
    for each in families:
        if each.answers_late:
            raise NotIdentifiableError(
                f"{each.name} has linear dynamics of its own, which hold any lag; leave out lag, "
                "or choose another family"
            )


def search_beside_lag(
    search: Search, found: Found, wanted: Wanted, options: Options
) -> tuple[Search, Options]:
    """Give how to search again for what else there is, as creep, with the lag that was found.

    Parameters
    ----------
    search
        Identifies without a lag.
    found
        What was found with a lag, or without.
    wanted, options
        As of ``found_with_lag``.

    Returns
    -------
    Search
        Gives models with that lag, free where it was estimated.
    Options
        With the delay that was found beside a free lag: both free are one too many.
    """
    if not isinstance(found.fit.family, LaggingFamily):
        return search, options
    tau, free = float(found.fit.solution.theta[-1]), wanted == AUTO

    def again(records: Cleaned, how: Options) -> Found:
        return _held(search(_lagged(records, tau), how), records.records, tau, free)

    return again, replace(options, delay=found.data.lag) if free else options


def _held(
    found: Found, records: Sequence[Record], time_constant: float, free: bool = False
) -> Found:
    """Give the model a lag that is known, and the records their own drive again."""
    data = found.data
    whole = tuple(replace(each, u=own.u) for each, own in zip(data.records, records, strict=True))
    data = replace(data, records=whole, measured_inputs=(), keeps_corners=False).delayed(data.lag)
    longest = LONGEST * time_constant
    fits = [
        _lagging(each, data.records[0].dt, time_constant, held=not free, longest=longest)
        for each in (found.fit, *found.rivals)
    ]
    return replace(found, data=data, fit=fits[0], rivals=tuple(fits[1:]))


def _lagging(
    fit: Fit, dt: float, time_constant: float, held: bool = False, longest: float = math.inf
) -> Fit:
    """Put a lag before the first stage of a fit."""
    values = np.array([time_constant])
    lower, upper = (values, values) if held else (np.array([SHORTEST * dt]), np.array([longest]))
    parametrization, theta = with_stage(
        fit.parametrization,
        fit.solution.theta,
        Lag(time_constant, dt),
        "drive",
        lower,
        np.minimum(upper, 1e6 * dt),
    )
    solution = replace(fit.solution, theta=theta)
    return Fit(LaggingFamily(fit.family), fit.size, parametrization, solution)


@dataclass(frozen=True, eq=False)
class _Tried:
    """A fit, its records, and what it leaves."""

    fit: Fit
    data: Data
    error: Array

    @classmethod
    def of(cls, fit: Fit, data: Data) -> _Tried:
        residual = fit.problem(data).residual(fit.solution.theta)
        return cls(fit, data, residual[: sum(data.lengths())])

    def late(self, dt: float) -> float:
        """Give by how much the output comes late in all, by delay and by lag, samples."""
        return self.data.lag + float(self.fit.solution.theta[-1]) / dt

    @property
    def cost(self) -> float:
        return float(self.error @ self.error)

    def far_better(self, other: _Tried) -> bool:
        """Tell whether it leaves less than another by more than noise makes of one constant."""
        variance = self.cost / self.error.size * correlation_time(self.error)
        return other.cost - self.cost > FAR * max(variance, np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class _Work:
    """What a search found, in units of powers of two, and the choice between lag and delay."""

    found: Found
    options: Options
    scales: tuple[float, float]
    data: Data
    fit: Fit

    @classmethod
    def of(cls, found: Found, options: Options) -> _Work:
        data = found.data
        scales = (
            _power_of_two(2.0 * data.half_range),
            _power_of_two(max(float(np.ptp(each.y)) for each in data.records)),
        )
        into = (1.0 / scales[0], 1.0 / scales[1])
        return cls(found, options, scales, data.in_units(*into), cls.scaled(found.fit, scales))

    @staticmethod
    def scaled(fit: Fit, scales: tuple[float, float]) -> Fit:
        """Give a fit in units smaller by these factors."""
        into = (1.0 / scales[0], 1.0 / scales[1])
        parametrization = fit.parametrization.in_units(fit.solution.theta, *into)
        return replace(fit, family=fit.family.in_units(*into), parametrization=parametrization)

    @property
    def dt(self) -> float:
        return self.data.records[0].dt

    def from_guesses(self, search: Search, records: Cleaned) -> _Tried | None:
        """Search with lags that are guessed, where without one nothing describes the records.

        A lag of many samples makes loops that are unlike those of any family, so no delay tells of
        it.
        """
        evidence = self.found.delay
        if evidence is None or evidence.high <= 0.0 or self._describes():
            return None
        tried = []
        for share in SHARES:
            tau = share * evidence.high * self.dt
            found = search(_lagged(records, tau), replace(self.options, delay=0))
            if not found.fit.family.answers_late:
                own = self.scaled(found.fit, self.scales)
                tried.append(self._with_lag(own, 0.0, tau, LONGEST * evidence.high * self.dt))
        return min(tried, key=lambda each: each.cost, default=None)

    def _describes(self) -> bool:
        return level_of(self.data, self.fit) == "good"

    def told(self, guessed: _Tried | None) -> Found:
        """Give what describes the records: a lag, a delay, or both; and say if none is sure.

        Parameters
        ----------
        guessed
            The best with a lag that was guessed, if any was.
        """
        delay = _Tried.of(self.fit, self._same_samples(self.data.lag))
        evidence = self.found.delay
        low = 0.0 if evidence is None else evidence.stated[0]
        shown = self.data.lag > 0.0 and low > 0.0
        tried = [] if guessed is None else [guessed]
        if shown:
            longest = LONGEST * self.data.lag * self.dt
            tried.append(self._with_lag(self.fit, 0.0, self.data.lag * self.dt, longest))
        lag = min(tried, key=lambda each: each.cost, default=None)
        if lag is None or not (shown or lag.far_better(delay)):
            return self._noted(
                "the records show no lag, so the model has none; records at higher frequencies "
                "would show a shorter one"
                if self._describes()
                else "no lag was found that describes the records, so the model has none"
            )
        return self._best(delay, lag)

    def _best(self, delay: _Tried, lag: _Tried) -> Found:
        """Choose between delay, lag and both, the simplest that none leaves far less than."""
        both = self._with_free_delay(lag)
        late = both.late(self.dt)
        if late > SETTLED or both.far_better(delay):
            # The loops themselves may be others than those found without a lag.
            alone = behind_lag(both.fit)
            other = self._with_free_delay(self._solved(alone, self._same_samples(late)))
            delay = other if other.far_better(delay) else delay
        if not both.far_better(lag) and not delay.far_better(lag):
            alike = not lag.far_better(delay)
            return self._taken(lag, self._beside(lag, alike), self._words(lag, delay, alike))
        if both.far_better(delay):
            told = "the records show a lag and a pure delay, both told apart"
            return self._taken(both, self._beside(both, alike=False), told)
        told = (
            "the records show a pure delay and not a first-order lag, so the model has none; the "
            "delay stands beside it"
        )
        if delay.fit is self.fit:
            return self._noted(told)
        return self._taken(delay, self._beside(delay, alike=False), told)

    def _words(self, lag: _Tried, delay: _Tried, alike: bool) -> str:
        tau = float(lag.fit.solution.theta[-1])
        if not alike:
            return "the records show a first-order lag and not a pure delay"
        return (
            f"a first-order lag of {tau:.3g} s and a pure delay of {delay.data.lag:.3g} samples "
            "describe the records alike; it was asked for as a lag, and its standard error takes "
            "that for granted; records at higher frequencies would tell them apart"
        )

    def _same_samples(self, delay: float) -> Data:
        """Give the records with another delay, compared at the same output samples for all."""
        data = self.data.delayed(delay)
        late = [
            max(a - b, 0) for a, b in zip(self.data.whole_lags(), data.whole_lags(), strict=True)
        ]
        starts = tuple(a + b for a, b in zip(data.starts, late, strict=True))
        return self.fit.family.fitted(replace(data, starts=starts, keeps_corners=False))

    def _with_lag(self, fit: Fit, delay: float, time_constant: float, longest: float) -> _Tried:
        first = _lagging(fit, self.dt, time_constant, longest=longest)
        return self._solved(first, self._same_samples(delay))

    def _solved(self, fit: Fit, data: Data) -> _Tried:
        kept = Overview(data, rates_matter=True).kept
        problem = fit.problem(data, kept)
        solution = fit.family.solve(problem, fit.solution.theta, self.options.max_iterations)
        return _Tried.of(self.options.converged(replace(fit, solution=solution)), data)

    def _with_free_delay(self, tried: _Tried) -> _Tried:
        """Let the delay beside a fit move to where both together leave least."""
        best = tried
        for _ in range(ROUNDS):
            late = lateness_of(best.data, best.fit)
            delay = max(best.data.lag + min(max(late.change, -1.0), 1.0), 0.0)
            if abs(late.change) <= TWO * late.error or abs(delay - best.data.lag) <= SETTLED:
                break
            best = self._solved(best.fit, self._same_samples(delay))
        return best

    def _beside(self, tried: _Tried, alike: bool) -> DelayEvidence | None:
        """Say what is left of a delay beside a lag; nothing where both are one and the same."""
        known, delay = self.found.delay, tried.data.lag
        if known is None:
            return None
        if alike:
            return replace(
                known, delay=0.0, low=0.0, high=0.0, excludes_zero=False, rate_or_lag=False
            )
        late = lateness_of(tried.data, tried.fit)
        half = BETWEEN_SAMPLES + (TWO * late.error if math.isfinite(late.error) else 0.0)
        low = min(delay + late.change - half, delay)
        high = max(delay + late.change + half, delay)
        return replace(
            known,
            delay=delay,
            low=round(low, 3),
            high=round(high, 3),
            describes=True,
            excludes_zero=not low <= 0.0 <= high,
            rate_or_lag=False,
        )

    def _taken(self, tried: _Tried, beside: DelayEvidence | None, note: str) -> Found:
        """Give the search with this fit, in the user's units."""
        theta = tried.fit.solution.theta
        parametrization = tried.fit.parametrization.in_units(theta, *self.scales)
        family = tried.fit.family.in_units(*self.scales)
        fit = replace(tried.fit, family=family, parametrization=parametrization)
        notes = (*self.found.notes, note)
        if isinstance(family, LaggingFamily) and not parametrization.inside(theta)[-1]:
            notes += (
                f"the time constant of the lag, {theta[-1]:.3g} s, is at the end of what was tried",
            )
        data = replace(self.found.data, keeps_corners=False)
        data = data.delayed(round(tried.data.lag, 3) or 0)
        rivals = self.found.rivals
        if isinstance(family, LaggingFamily):
            tau = float(theta[-1])
            rivals = tuple(_lagging(each, self.dt, tau, held=True) for each in rivals)
        return replace(self.found, fit=fit, data=data, notes=notes, rivals=rivals, delay=beside)

    def _noted(self, note: str) -> Found:
        return replace(self.found, notes=(*self.found.notes, note))


def _power_of_two(span: float) -> float:
    return math.ldexp(1.0, math.frexp(span)[1] - 1)

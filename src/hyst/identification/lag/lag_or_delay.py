"""Whether what comes late is a first-order lag, a pure delay, or both."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.errors import SolverError
from hyst.identification.choice.joint_delay import BETWEEN_SAMPLES
from hyst.identification.families.family import Fit
from hyst.identification.families.staged_family import without_stage
from hyst.identification.judgement.judge import level_of
from hyst.identification.judgement.regression import correlation_time
from hyst.identification.lag.lagging_family import LaggingFamily
from hyst.identification.lag.stage import LONGEST, lagged, lagging
from hyst.identification.options import Options
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.lateness import lateness_of
from hyst.identification.search import Found

Array = NDArray[np.float64]
Search = Callable[[Cleaned, Options], Found]

FAR = 20.0
"""Variance ratio of one constant: noise reaches it once in a hundred thousand times."""

ROUNDS = 6
SHARES = (0.25, 0.5, 1.0)
"""Of the longest delay possible: time constants to search with where nothing describes the records
without a lag."""

SETTLED = 0.05
"""Samples: a change of the delay beside a lag that is worth no further round."""

TWO = 2.0


@dataclass(frozen=True, eq=False)
class Tried:
    """A fit, its records, and what it leaves.

    Parameters
    ----------
    fit, data
        The fit and what it was made to.
    error
        Shape (samples used,).
    """

    fit: Fit
    data: Data
    error: Array

    @classmethod
    def of(cls, fit: Fit, data: Data) -> Tried:
        """Find what a fit leaves.

        Parameters
        ----------
        fit, data
            The fit and what it was made to.
        """
        residual = fit.problem(data).residual(fit.solution.theta)
        return cls(fit, data, residual[: sum(data.lengths())])

    def late(self, dt: float) -> float:
        """Give by how much the output comes late in all, by delay and by lag, samples."""
        return self.data.lag + float(self.fit.solution.theta[-1]) / dt

    @property
    def cost(self) -> float:
        """Sum of squares."""
        return float(self.error @ self.error)

    def far_better(self, other: Tried) -> bool:
        """Tell whether it leaves less than another by more than noise makes of one constant."""
        variance = self.cost / self.error.size * correlation_time(self.error)
        return other.cost - self.cost > FAR * max(variance, np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class LagOrDelay:
    """What a search found, in units of powers of two, and the choice between lag and delay.

    Parameters
    ----------
    found
        In the user's units.
    options
        What the user wants.
    scales
        Of input and output: numbers of the user over those worked on.
    data, fit
        Those of ``found``, in units in which ranges lie between 1 and 2.
    """

    found: Found
    options: Options
    scales: tuple[float, float]
    data: Data
    fit: Fit

    @classmethod
    def of(cls, found: Found, options: Options) -> LagOrDelay:
        """Bring what was found into the units that are worked in.

        Parameters
        ----------
        found, options
            As of the class.
        """
        data = found.data
        scales = (
            _power_of_two(2.0 * data.half_range),
            _power_of_two(max(float(np.ptp(each.y)) for each in data.records)),
        )
        into = (1.0 / scales[0], 1.0 / scales[1])
        return cls(found, options, scales, data.in_units(*into), cls.scaled(found.fit, scales))

    @staticmethod
    def scaled(fit: Fit, scales: tuple[float, float]) -> Fit:
        """Give a fit in units smaller by these factors.

        Parameters
        ----------
        fit
            In larger units.
        scales
            Of input and output.
        """
        into = (1.0 / scales[0], 1.0 / scales[1])
        parametrization = fit.parametrization.in_units(fit.solution.theta, *into)
        return replace(fit, family=fit.family.in_units(*into), parametrization=parametrization)

    @property
    def dt(self) -> float:
        """Sample time of the first record, s."""
        return self.data.records[0].dt

    def from_guesses(self, search: Search, records: Cleaned) -> Tried | None:
        """Search with lags that are guessed, where without one nothing describes the records.

        A lag of many samples makes loops that are unlike those of any family, so no delay tells of
        it.

        Parameters
        ----------
        search
            Identifies without a lag.
        records
            What from.
        """
        evidence = self.found.delay
        if evidence is None or evidence.high <= 0.0 or self._describes():
            return None
        tried = []
        for share in SHARES:
            tau = share * evidence.high * self.dt
            found = search(lagged(records, tau), replace(self.options, delay=0))
            if found.fit.family.answers_late:
                continue
            own = self.scaled(found.fit, self.scales)
            with suppress(SolverError):  # a guess that ends nowhere is none, as where it creeps
                tried.append(self._with_lag(own, 0.0, tau, LONGEST * evidence.high * self.dt))
        return min(tried, key=lambda each: each.cost, default=None)

    def _describes(self) -> bool:
        return level_of(self.data, self.fit) == "good"

    def told(self, guessed: Tried | None) -> Found:
        """Give what describes the records: a lag, a delay, or both; and say if none is sure.

        Parameters
        ----------
        guessed
            The best with a lag that was guessed, if any was.
        """
        delay = Tried.of(self.fit, self._same_samples(self.data.lag))
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

    def _best(self, delay: Tried, lag: Tried) -> Found:
        """Choose between delay, lag and both, the simplest that none leaves far less than."""
        both = self._with_free_delay(lag)
        late = both.late(self.dt)
        if late > SETTLED or both.far_better(delay):
            # The loops themselves may be others than those found without a lag.
            alone = without_stage(both.fit)
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

    def _words(self, lag: Tried, delay: Tried, alike: bool) -> str:
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

    def _with_lag(self, fit: Fit, delay: float, time_constant: float, longest: float) -> Tried:
        first = lagging(fit, self.dt, time_constant, longest=longest)
        return self._solved(first, self._same_samples(delay))

    def _solved(self, fit: Fit, data: Data) -> Tried:
        overview, most = Overview(data, rates_matter=True), self.options.max_iterations
        problem = fit.problem(data, overview.kept)
        solution = fit.family.solve(problem, fit.solution.theta, most)
        fit = fit.family.renewed(replace(fit, solution=solution), overview, most)
        return Tried.of(self.options.converged(fit), data)

    def _with_free_delay(self, tried: Tried) -> Tried:
        """Let the delay beside a fit move to where both together leave least."""
        best = tried
        for _ in range(ROUNDS):
            late = lateness_of(best.data, best.fit)
            delay = max(best.data.lag + min(max(late.change, -1.0), 1.0), 0.0)
            if abs(late.change) <= TWO * late.error or abs(delay - best.data.lag) <= SETTLED:
                break
            best = self._solved(best.fit, self._same_samples(delay))
        return best

    def _beside(self, tried: Tried, alike: bool) -> DelayEvidence | None:
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

    def _taken(self, tried: Tried, beside: DelayEvidence | None, note: str) -> Found:
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
            rivals = tuple(lagging(each, self.dt, tau, held=True) for each in rivals)
        return replace(self.found, fit=fit, data=data, notes=notes, rivals=rivals, delay=beside)

    def _noted(self, note: str) -> Found:
        return replace(self.found, notes=(*self.found.notes, note))


def _power_of_two(span: float) -> float:
    return math.ldexp(1.0, math.frexp(span)[1] - 1)

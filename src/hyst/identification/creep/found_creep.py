"""Creep beside the model that a search has found without it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError, SolverError
from hyst.identification.creep.creeping import Creeping, by_name, over_windows, taken_out
from hyst.identification.creep.creeping_family import CreepingFamily
from hyst.identification.creep.evidence import (
    LARGEST,
    Evidence,
    Look,
    evenly,
    evidence_of,
    lateness,
    nuisances_of,
)
from hyst.identification.creep.joint_fit import MOST_LAGS, Joint, lags_of
from hyst.identification.creep.lags import answers, bounds_of, signals_that_creep
from hyst.identification.creep.merging import merged
from hyst.identification.creep.told import (
    DriftBeside,
    require_told,
)
from hyst.identification.creep.wanted import DYNAMICS, Wanted
from hyst.identification.families.family import Fit
from hyst.identification.families.option import AUTO
from hyst.identification.families.staged_family import staged_of
from hyst.identification.fit.nuisance import (
    Beside,
    over_whole_records,
)
from hyst.identification.fit.problem import model_output
from hyst.identification.fit.stages import with_stage
from hyst.identification.options import Options
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.part_of_a_sample import by_whole_samples
from hyst.identification.record_use.used_samples import Data
from hyst.identification.search import Found
from hyst.operators import Affine, Composition, Operator

Array = NDArray[np.float64]

ROUNDS = 2
"""Of looking for creep and searching again without it, before all is fitted together."""

SURE_OF_DELAY = 2.5
"""Standard errors that a delay beside creep must exceed."""

LEAST_DELAY = 0.02
"""Samples: less is none."""


def with_creep(
    found: Found,
    records: Cleaned,
    wanted: Wanted,
    drifts: bool,
    search: Callable[[Cleaned, Options], Found],
    options: Options,
) -> Creeping:
    """Find creep beside what a search has found, if it is asked for or the records show it.

    What lags of the model's output explain is taken out of the records, the search is run again
    on what is left, and so on; then hysteresis, weights and time constants are fitted together.

    Parameters
    ----------
    found
        The search without creep.
    records
        What it was made on, but with the drift, which may be creep, left in.
    wanted
        As of ``identify``.
    drifts
        Whether the output may drift beside its creep.
    search
        Repeats the search on other records, with other options.
    options
        What the user wants.

    Raises
    ------
    NotIdentifiableError
        If creep is asked for and the family has no place for it.
    """
    as_it_was = Creeping(found, None, (), taken_out(found.data, records))
    if wanted is None:
        return as_it_was
    why = _no_place(found.fit)
    if why and wanted != AUTO:
        raise NotIdentifiableError(why)
    drifted = any(each is not None for each in records.drifts)
    if wanted == AUTO and (why or (not drifted and found.leaves_noise)):
        return as_it_was
    options.say("creep")
    work = _Work(records, drifts, _scales(found.data))
    first = found
    if drifted:
        # What was taken for drift may be creep, and bends a model where it is taken out.
        try:
            found = search(records, options)
        except SolverError:
            if wanted != AUTO:
                raise
            return as_it_was
        if _no_place(found.fit):
            return as_it_was
    seen = evidence_of(*work.scaled(found), drifts, only_if_shown=wanted == AUTO)
    if wanted != AUTO:
        require_told(seen)
    without = replace(as_it_was, evidence=replace(seen, shown=False), asked=wanted != AUTO)
    if not seen.weights.size or (wanted == AUTO and not seen.shown):
        return without
    try:
        creeping = work.creeping(first, found, seen, wanted, search, options)
    except SolverError:
        if wanted != AUTO:
            raise
        # Nobody asked for it: what was found before stands, and says so.
        return replace(without, evidence=seen, asked=True)
    return without if creeping is None else creeping


@dataclass(frozen=True, eq=False)
class _Work:
    """The records with their drift, and the units in which they are worked on.

    Parameters
    ----------
    records
        With the drift left in.
    drifts
        Whether the output may drift beside its creep.
    scales
        Of input and output: numbers of the user over those that are worked on.
    """

    records: Cleaned
    drifts: bool
    scales: tuple[float, float]

    def scaled(self, found: Found) -> tuple[Data, Fit]:
        """Give the records with their drift and a fit, in units in which ranges are 1 to 2."""
        into, out = (1.0 / each for each in self.scales)
        data = self._given(found.data).in_units(into, out)
        parametrization = found.fit.parametrization.in_units(found.fit.solution.theta, into, out)
        family = found.fit.family.in_units(into, out)
        return data, replace(found.fit, family=family, parametrization=parametrization)

    def creeping(
        self,
        first: Found,
        found: Found,
        seen: Evidence,
        wanted: Wanted,
        search: Callable[[Cleaned, Options], Found],
        options: Options,
    ) -> Creeping | None:
        """Search again without what lags explain, then fit all together; None if none is left."""
        for _ in range(ROUNDS):
            known = replace(options, delay=_delay_beside(found, seen, options))
            again = search(self.records.without(self.creep_and_beside(found, seen)), known)
            if _no_place(again.fit):
                break
            found, seen = again, evidence_of(*self.scaled(again), self.drifts)
            if not seen.weights.size:
                return None
        options.say("creep: all constants together")
        found = replace(found, delay=first.delay)
        found, joint, fit = self.fitted(found, seen, wanted, options)
        if fit is None or (wanted == AUTO and float(lags_of(fit)[0].sum()) > LARGEST):
            return None  # free lags may come to be dynamics, too
        return self.told(found, joint, options.converged(fit))

    def _given(self, data: Data) -> Data:
        pairs = zip(data.records, self.records.records, strict=True)
        records = tuple(replace(each, y=whole.y) for each, whole in pairs)
        return self.records.marked(replace(data, records=records, disturbances=()))

    def creep_and_beside(self, found: Found, seen: Evidence) -> list[Array]:
        """Give for each record what its lags, drift and settling make, in the user's units."""
        data, fit = self.scaled(found)
        count = min(seen.weights.size, MOST_LAGS)
        weights, tau = merged(seen.weights, seen.time_constants, count, bounds_of(data))
        nuisances = nuisances_of(count, self.drifts)
        look = Look(data, fit, nuisances, tau, evenly(data))
        weights, _ = look.with_positive_weights()
        beside = over_whole_records(data, nuisances, tau, look.coefficients(weights))
        signals = signals_that_creep(data, fit, whole=True)
        late = data.whole_lags()
        lags = [each @ weights for each in answers(data, signals, tau)]
        return [
            self.scales[1] * (by_whole_samples(a, k) + b)
            for a, b, k in zip(lags, beside, late, strict=True)
        ]

    def fitted(
        self, found: Found, seen: Evidence, wanted: Wanted, options: Options
    ) -> tuple[Found, Joint, Fit | None]:
        """Fit all constants together, with the lags asked for or those that pay.

        A delay that was taken for 0 would make lags of a few samples, so where it may be free it
        is found again beside the creep.
        """
        free = options.delay == AUTO
        joint = self._joint(found, free, options)
        front, guess = self.scaled(found)[1], (seen.weights, seen.time_constants)
        if wanted == AUTO:
            fit = joint.best_number(front, *guess)
        else:
            assert isinstance(wanted, int), "it was checked"
            fit = joint.fit(front, *guess, wanted, joint.searched())
        if free:
            found, joint = self._delayed(found, joint, fit, options)
        return found, joint, joint.finished(fit)

    def _joint(self, found: Found, late: bool, options: Options) -> Joint:
        data, fit = self.scaled(found)
        kept = None if fit.family.depends_on_rate else Overview(found.data).kept
        changes = tuple(lateness(data, signals_that_creep(data, fit))) if late else ()
        return Joint(data, self.drifts, changes, kept, options.max_iterations)

    def _delayed(
        self, found: Found, joint: Joint, fit: Fit, options: Options
    ) -> tuple[Found, Joint]:
        """Give the records with the delay that is found beside creep, if it is none by chance."""
        late, error = joint.delay(fit)
        dt, lag = found.data.records[0].dt, found.data.lag
        low, high = (late + side * error for side in (-SURE_OF_DELAY, SURE_OF_DELAY))
        delay = _later(found, late, error)
        evidence = found.delay
        if evidence is not None:
            evidence = replace(
                evidence,
                delay=delay,
                low=min(lag + low / dt, delay),
                high=max(lag + high / dt, delay),
                excludes_zero=bool(lag + low / dt > 0.0 or lag + high / dt < 0.0),
                rate_or_lag=False,
            )
        found = replace(found, data=found.data.delayed(delay), delay=evidence)
        return found, self._joint(found, True, options)

    def told(self, found: Found, joint: Joint, fit: Fit) -> Creeping:
        """Give a search with this fit, in the user's units; drift and settling are none of it."""
        theta, data = fit.solution.theta, joint.data
        count = lags_of(fit)[0].size
        # What comes late is the delay's, and none of what is taken out.
        nuisances = nuisances_of(count, self.drifts, theta.size - count)
        left = data.measured() - model_output(data, fit.operator)
        coefficients = Beside(data, nuisances).at(theta).coefficients(left)
        beside = by_name(data, nuisances, theta, coefficients, self.scales[1])
        taken = self.records.without(
            [np.sum(each, axis=0) for each in zip(*beside.values(), strict=True)]
        )
        given = self._given(found.data)
        pairs = zip(given.records, taken.records, strict=True)
        records = tuple(replace(each, y=whole.y) for each, whole in pairs)
        family = CreepingFamily(found.fit.family)
        parametrization = fit.parametrization.in_units(theta, *self.scales)
        creep = staged_of(fit).stage.with_parameters(np.concatenate(lags_of(fit)))
        drifts = tuple(
            DriftBeside(number, self.scales[1] * total, self.scales[1] * error)
            for number, (total, error) in enumerate(joint.drift(fit), 1)
        )
        found = replace(
            found,
            fit=replace(fit, family=family, parametrization=parametrization),
            data=taken.marked(replace(given, records=records, disturbances=())),
            rivals=tuple(_creeping_rival(each, creep) for each in found.rivals),
        )
        return Creeping(found, None, drifts, {k: over_windows(given, v) for k, v in beside.items()})


def _delay_beside(found: Found, seen: Evidence, options: Options) -> float | str:
    """Give the delay for the next search: what creep leaves of it, if it is to be found at all."""
    return _later(found, seen.late, seen.late_error) if options.delay == AUTO else options.delay


def _later(found: Found, late: float, error: float) -> float:
    """Give the delay in samples that is later by some time: 0 or whole where it may be."""
    dt = found.data.records[0].dt
    delay = found.data.lag + late / dt
    if abs(delay) <= max(SURE_OF_DELAY * error / dt, LEAST_DELAY):
        return 0
    whole = round(delay)
    return whole if abs(delay - whole) <= LEAST_DELAY else round(delay, 3)


def _creeping_rival(fit: Fit, creep: Operator) -> Fit:
    """Let another model that describes the records as well creep in the same way."""
    if _no_place(fit):
        return fit
    values = creep.parameters().values
    parametrization, theta = with_stage(
        fit.parametrization, fit.solution.theta, creep, "output", values, values
    )
    solution = replace(fit.solution, theta=theta)
    return Fit(CreepingFamily(fit.family), fit.size, parametrization, solution)


def _no_place(fit: Fit) -> str:
    """Say why a model cannot have creep behind its hysteresis; empty if it can."""
    if fit.family.answers_late:
        return DYNAMICS.format(fit.family.name)
    operator = fit.operator
    last = operator.parts[-1] if isinstance(operator, Composition) else operator
    if isinstance(last, Affine):
        return ""
    return (
        f"creep is not identified with {fit.family.name}, whose offset is not its last stage and "
        "would creep; choose another family, or leave creep out"
    )


def _scales(data: Data) -> tuple[float, float]:
    """Give powers of two whose ratio to the ranges of both signals lies between 1 and 2."""
    spans = 2.0 * data.half_range, max(float(np.ptp(each.y)) for each in data.records)
    into, out = (math.ldexp(1.0, math.frexp(span)[1] - 1) for span in spans)
    return into, out

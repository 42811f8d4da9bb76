"""From records and families to one final fit: units, delay, choice, fit.

Everything between first sight of the records and the final fit is done on records in units of
powers of two in which the ranges of both signals lie between 1 and 2. So scaling a
record by powers of two scales the result, bit for bit; other factors change the rounding of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.choice.delay import find_delay, settled_by_family, usable_delay
from hyst.identification.choice.selection import (
    Contender,
    best_of_starts,
    compare,
    not_compared,
    settled,
    simplest_good,
)
from hyst.identification.families.family import Family, Fit
from hyst.identification.families.option import AUTO
from hyst.identification.fit.bounded_least_squares import CONVERGED
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.options import Options, as_delay
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import Candidate

MOST_STARTS = 3
"""Of the final fit."""


@dataclass(frozen=True, eq=False)
class Found:
    """A final fit, the records it was made on, and what it was chosen from.

    Parameters
    ----------
    fit
        The fit.
    data
        Its records, with their delay.
    candidates
        What was compared; empty if there was nothing to choose.
    notes
        Sentences about what was left out before the fit.
    delay
        What the records say of their delay; None where it was given, or is part of the model.
    """

    fit: Fit
    data: Data
    candidates: tuple[Candidate, ...]
    notes: tuple[str, ...]
    delay: DelayEvidence | None


@dataclass(frozen=True, eq=False)
class _Task:
    """A family, the records it uses, in powers of two of the user's units, and their scales."""

    family: Family
    given: Data
    data: Data
    scales: tuple[float, float]
    notes: tuple[str, ...]
    evidence: DelayEvidence | None = None

    def delayed(self, delay: float, evidence: DelayEvidence | None) -> _Task:
        given, data = self.given.delayed(delay), self.data.delayed(delay)
        return replace(self, given=given, data=data, evidence=evidence)

    def searched(self) -> Data:
        """Give what the search fits to."""
        return self.family.searched(self.data)


def find(records: Cleaned, families: Sequence[Family], options: Options) -> Found:
    """Choose delay, family and size, and fit it.

    Long records are searched in thinned form; the last fit takes every sample. An automatic delay
    is found before the family is known, and is 0 unless the records exclude it; among those that
    they leave possible a family that describes them may choose.

    Parameters
    ----------
    records
        The training records, cleaned.
    families
        From the simplest to the richest.
    options
        What the user wants.

    Returns
    -------
    Found
        In the user's units.

    Raises
    ------
    InputError, NotIdentifiableError, SolverError
        As ``identify``.
    """
    tasks, left_out = _tasks(families, records, options)
    _require_samples(tasks)
    _require_same_records(tasks)
    if any(not task.family.answers_late for task in tasks):
        options.say("delay")
    tasks = _with_delay(tasks, options)
    _require_samples(tasks)
    fit, task, candidates, refusals = _search(tasks, options)
    if task.evidence is not None and fit.family.has_memory:
        delay = settled_by_family(task.data, fit, task.evidence)
        if delay != task.data.lag:
            options.say("delay, settled by the family")
            shifted = [t if t.family.answers_late else t.delayed(delay, t.evidence) for t in tasks]
            fit, task, candidates, refusals = _search(shifted, options)
    if task.searched() is not task.data:
        fit = _polished(fit, task, options)
    fit = replace(fit, parametrization=_in_given_units(fit, task))
    notes = task.notes + left_out + refusals
    return Found(fit, task.given, candidates, notes, task.evidence)


def _tasks(
    families: Sequence[Family], records: Cleaned, options: Options
) -> tuple[list[_Task], tuple[str, ...]]:
    """Prepare the families that the records can serve, and say why others are not compared."""
    used = dict[Family, tuple[Data, tuple[str, ...]]]()
    refusals = dict[str, NotIdentifiableError]()
    for family in families:
        try:
            data, left_out = family.records_to_use(records.records, options.start)
            used[family] = records.marked(data), left_out
        except NotIdentifiableError as refusal:
            refusals[family.name] = refusal
    if not used:
        raise next(iter(refusals.values()))
    return [_task(family, *each) for family, each in used.items()], not_compared(refusals)


def _task(family: Family, given: Data, left_out: tuple[str, ...]) -> _Task:
    suited, notes = family.suited(given)
    scales = (
        _power_of_two(2.0 * given.half_range),
        _power_of_two(max(float(np.ptp(each.y)) for each in given.records)),
    )
    data = given.in_units(1.0 / scales[0], 1.0 / scales[1])
    return _Task(
        suited.in_units(1.0 / scales[0], 1.0 / scales[1]), given, data, scales, left_out + notes
    )


def _power_of_two(span: float) -> float:
    """Give the power of two whose ratio to a range lies between 1 and 2."""
    return math.ldexp(1.0, math.frexp(span)[1] - 1)


def _require_samples(tasks: Sequence[_Task]) -> None:
    """Refuse records with no more samples than the smallest model has parameters."""
    needed = min(each.family.least_parameters(each.family.sizes()[0]) for each in tasks)
    samples = tasks[0].data.measured().size
    if samples <= needed:
        raise NotIdentifiableError(
            f"{samples} samples can be used but the model has {needed} parameters; give a longer "
            "record or fewer plays"
        )


def _require_same_records(tasks: Sequence[_Task]) -> None:
    """Refuse to compare what was judged by other records, as by averages of periods."""
    first = tasks[0]
    for task in tasks[1:]:
        if any(a is not b for a, b in zip(task.given.records, first.given.records, strict=True)):
            raise InputError(
                f"families {first.family.name!r} and {task.family.name!r} would be compared by "
                "other records, since one of them averages periods; leave out period, and give "
                "averages of the periods as the records"
            )


def _with_delay(tasks: Sequence[_Task], options: Options) -> list[_Task]:
    """Give every task its delay; a family that answers late by itself takes it as an option."""
    found: dict[int, DelayEvidence] = {}
    result = []
    for task in tasks:
        if task.family.answers_late:
            result.append(task)
            continue
        if options.delay != AUTO:
            result.append(task.delayed(as_delay(options.delay, task.given), None))
            continue
        key = min(task.given.starts)
        if key not in found:
            found[key] = find_delay(task.data)
        result.append(task.delayed(usable_delay(found[key], task.data), found[key]))
    return result


def _search(
    tasks: Sequence[_Task], options: Options
) -> tuple[Fit, _Task, tuple[Candidate, ...], tuple[str, ...]]:
    """Choose family and size and fit it; the next best one if that fit does not converge."""
    if len(tasks) == 1 and len(tasks[0].family.sizes()) == 1:
        task = tasks[0]
        overview = Overview(task.searched(), options.delay)
        size = task.family.sizes()[0]
        fit = _final_fit(task.family, overview, size, options)
        return options.converged(fit), task, (), ()
    contenders, refusals = compare(_with_overviews(tasks, options), options.say)
    remaining = list(contenders)
    while True:
        chosen = simplest_good(remaining, contenders[0].overview.output_range)
        fit = _final_fit(chosen.family, chosen.overview, chosen.candidate.plays, options)
        if fit.solution.status == CONVERGED or len(remaining) == 1:
            break
        remaining.remove(chosen)
    task = next(each for each in tasks if each.family is chosen.family)
    scale = task.scales[1]
    told = tuple(_told(each, chosen, scale) for each in contenders)
    return options.converged(fit), task, told, refusals


def _with_overviews(tasks: Sequence[_Task], options: Options) -> list[tuple[Family, Overview]]:
    """Give every family its records; those that use the same share what is found out."""
    shared: dict[tuple[bool, tuple[int, ...], int], Overview] = {}
    result = []
    for task in tasks:
        key = (task.family.depends_on_rate, task.data.starts, task.data.delay)
        if key not in shared:
            shared[key] = Overview(task.searched(), options.delay)
        result.append((task.family, shared[key]))
    return result


def _told(contender: Contender, chosen: Contender, scale: float) -> Candidate:
    """Give a candidate in the user's units, and say whether it was chosen."""
    candidate = contender.candidate
    return replace(
        candidate,
        score=candidate.score * scale,
        standard_error=candidate.standard_error * scale,
        chosen=contender is chosen,
    )


def _final_fit(family: Family, overview: Overview, size: int, options: Options) -> Fit:
    """Fit from all starts, improve it as the family knows, and without idle parts."""
    options.say(f"final fit: {family.named_size(size)}")
    most = options.max_iterations
    fit = best_of_starts(family, overview, size, MOST_STARTS, most)
    fit = family.finish(fit, overview, most)
    return settled(family.simplified(fit, overview, most), overview, most)


def _polished(fit: Fit, task: _Task, options: Options) -> Fit:
    """Go on with all samples."""
    options.say("final fit: all samples")
    overview = Overview(fit.family.fitted(task.data), options.delay)
    problem = fit.problem(overview.data)
    found = fit.family.solve(problem, fit.solution.theta, options.max_iterations)
    polished = settled(replace(fit, solution=found), overview, options.max_iterations)
    return options.converged(fit.family.simplified(polished, overview, options.max_iterations))


def _in_given_units(fit: Fit, task: _Task) -> Parametrization:
    return fit.parametrization.in_units(fit.solution.theta, *task.scales)

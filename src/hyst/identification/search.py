"""From records and families to one final fit: units, delay, choice, fit.

Everything between first sight of the records and the final fit is done on records in units of
powers of two in which the ranges of both signals lie between 1 and 2. So scaling a
record by powers of two scales the result, bit for bit; other factors change the rounding of it.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.choice.cross_validation import fewest_left
from hyst.identification.choice.delay import OWN, find_delay, told_by_family, usable_delay
from hyst.identification.choice.fits_from_starts import best_of_starts, settled
from hyst.identification.choice.joint_delay import with_joint_delay
from hyst.identification.choice.overviews import with_overviews
from hyst.identification.choice.rivals import other_signs, rivals_of
from hyst.identification.choice.selection import (
    Contender,
    as_good_as_best,
    compare,
    contender_of,
    in_reserve,
    not_compared,
    simplest_good,
)
from hyst.identification.choice.sign_of_weights import Ruling, ruled
from hyst.identification.choice.task import Task
from hyst.identification.choice.told import about_the_choice
from hyst.identification.families.family import Family, Fit
from hyst.identification.families.option import AUTO
from hyst.identification.fit.bounded_least_squares import CONVERGED
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.judgement.judge import level_of
from hyst.identification.options import Options, as_delay
from hyst.identification.progress import FAMILIES, RESERVE
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.scales import scales_of
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import Candidate
from hyst.operators.verdict import Level

MOST_STARTS = 3
"""Of the final fit."""

MOST_DELAYS = 3
"""Times that a family may change the delay: its grid is made for the one before."""


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
        Sentences about what was left out before the fit, and about the choice.
    rivals
        Fits of other kinds that describe the records about as well, one of each kind: what they
        say of other drives is as likely.
    delay
        What the records say of their delay; None where it was given, or is part of the model.
    """

    fit: Fit
    data: Data
    candidates: tuple[Candidate, ...]
    notes: tuple[str, ...]
    rivals: tuple[Fit, ...]
    delay: DelayEvidence | None

    @functools.cached_property
    def leaves_noise(self) -> bool:
        """Whether what the fit leaves is noise."""
        return level_of(self.data, self.fit) == "good"


def find(
    records: Cleaned,
    families: Sequence[Family],
    options: Options,
    reserve: Sequence[Family] = (),
) -> Found:
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
    reserve
        Families that are compared only where those leave more than noise; what they cannot serve
        is no matter of the user's, who has not named them.

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
    more = _in_reserve(reserve, records, tasks[0], options)
    try:
        choice = _search(tasks, options, more)
    except NotIdentifiableError:
        if not any(each.delay_is_unsure() for each in tasks):
            raise
        # What is taken for a delay may be the very loop that the families look for.
        tasks, more = ([each.without_unsure_delay() for each in all_] for all_ in (tasks, more))
        choice = _search(tasks, options, more)
    choice = _with_settled_delay(choice, tasks, more, options)
    fit, task = choice.fit, choice.task
    if task.searched() is not task.data:
        fit = _polished(fit, task, options)
    fit, task = with_joint_delay(fit, task, options.max_iterations)
    fit, *rivals = (
        replace(each, parametrization=_in_given_units(each, task)) for each in (fit, *choice.rivals)
    )
    notes = task.notes + left_out + choice.notes + _outlying(task, options)
    data = fit.family.without_past(fit, task.given)
    return Found(fit, data, choice.candidates, notes, tuple(rivals), task.evidence)


def _tasks(
    families: Sequence[Family], records: Cleaned, options: Options
) -> tuple[list[Task], tuple[str, ...]]:
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


def _task(family: Family, given: Data, left_out: tuple[str, ...]) -> Task:
    suited, notes = family.suited(given)
    scales = scales_of(given)
    given = replace(given, keeps_corners=not family.depends_on_rate)
    data = given.in_units(1.0 / scales[0], 1.0 / scales[1])
    return Task(
        suited.in_units(1.0 / scales[0], 1.0 / scales[1]), given, data, scales, left_out + notes
    )


def _in_reserve(
    reserve: Sequence[Family], records: Cleaned, beside: Task, options: Options
) -> list[Task]:
    """Prepare those families in reserve that use the same samples, with the delay found."""
    if not reserve or beside.family.answers_late:
        return []
    try:
        tasks, _ = _tasks(reserve, records, options)
    except NotIdentifiableError:
        return []
    same = [each for each in tasks if each.data.starts == beside.data.starts]
    return [each.delayed(beside.given.lag, beside.evidence) for each in same]


def _require_samples(tasks: Sequence[Task]) -> None:
    """Refuse records with no more samples than the smallest model has parameters."""
    needed = min(each.family.least_parameters(each.family.sizes()[0]) for each in tasks)
    samples = tasks[0].data.measured().size
    if samples <= needed:
        raise NotIdentifiableError(
            f"{samples} samples can be used but the model has {needed} parameters; give a longer "
            "record or fewer plays"
        )


def _require_same_records(tasks: Sequence[Task]) -> None:
    """Refuse to compare what was judged by other records, as by averages of periods."""
    first = tasks[0]
    for task in tasks[1:]:
        pairs = zip(task.given.records, first.given.records, strict=True)
        if any(not np.array_equal(one.y, other.y) for one, other in pairs):
            raise InputError(
                f"families {first.family.name!r} and {task.family.name!r} would be compared by "
                "other records, since one of them averages periods; leave out period, and give "
                "averages of the periods as the records"
            )


def _with_delay(tasks: Sequence[Task], options: Options) -> list[Task]:
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
        own = found[key] if task.family.loops_tell_delay is True else found[key].undecided()
        result.append(task.delayed(usable_delay(own, task.data), own))
    return result


@dataclass(frozen=True, eq=False)
class _Choice:
    """A final fit in the units of its task, what it was chosen from and what else may be right."""

    fit: Fit
    task: Task
    candidates: tuple[Candidate, ...]
    notes: tuple[str, ...]
    rivals: tuple[Fit, ...]


def _search(tasks: Sequence[Task], options: Options, reserve: Sequence[Task]) -> _Choice:
    """Choose signs, family and size and fit it; the next best if that does not converge."""
    prepared = with_overviews([*tasks, *reserve], options.delay, options.known)
    ruling = ruled(prepared[: len(tasks)])
    if len(tasks) == 1 and len(tasks[0].family.sizes()) == 1:
        return _only(tasks[0], ruling, options)
    contenders, refusals = compare(ruling.families, options.say.part(*FAMILIES))
    chosen, fit = _best(contenders, options)
    level = _level(chosen.overview, fit) if reserve else "good"
    if level != "good":
        more = in_reserve(prepared[len(tasks) :], chosen, options.say.part(*RESERVE))
        may_win = _may_win(more, chosen, describes=level == "fair")
        chosen, fit = _best(_preferred((*contenders, *may_win)), options, (chosen, fit))
        contenders += more
    task = next(each for each in (*tasks, *reserve) if each.family.name == chosen.candidate.family)
    rivals = rivals_of(chosen, fit, contenders, other_signs(ruling, chosen))
    tied, scale = as_good_as_best(contenders), task.scales[1]
    told = tuple(_told(each, chosen, each in tied, scale) for each in contenders)
    notes = refusals + about_the_choice(chosen, contenders, rivals, scale)
    return _Choice(options.converged(fit), task, told, notes, rivals.fits)


def _may_win(more: Sequence[Contender], chosen: Contender, describes: bool) -> Sequence[Contender]:
    """Give those of a reserve that a record can prefer to what describes it.

    Strokes of one amplitude say nothing of the loops inside, so closeness alone prefers none: only
    what leaves nothing but noise with no more constants.
    """
    if chosen.overview.shows_minor_loops or not describes:
        return more
    most = chosen.candidate.parameters
    return [each for each in more if each.candidate.parameters <= most and _leaves_noise(each)]


def _with_settled_delay(
    choice: _Choice, tasks: list[Task], more: list[Task], options: Options
) -> _Choice:
    """Let the chosen family settle the delay, and choose again with it."""
    for _ in range(MOST_DELAYS):
        fit, task = choice.fit, choice.task
        if task.evidence is None or not (fit.family.has_memory and fit.family.settles_delay):
            break
        delay, told = told_by_family(task.data, fit, task.evidence)
        if delay == task.data.lag:
            break
        options.say("delay, settled by the family")
        tasks, more = (
            [t if t.family.answers_late else t.delayed(delay, told) for t in each]
            for each in (tasks, more)
        )
        choice = _search(tasks, options, more)
        if choice.fit.family.loops_tell_delay != OWN:
            break
    return choice


def _preferred(contenders: Sequence[Contender]) -> Sequence[Contender]:
    """Give those of a tie that leave only noise, if there are any; else all."""
    return [each for each in as_good_as_best(contenders) if _leaves_noise(each)] or contenders


def _leaves_noise(contender: Contender) -> bool:
    return _level(contender.overview, contender.fit) == "good"


def _level(overview: Overview, fit: Fit) -> Level:
    return overview.once(("level", fit), lambda: level_of(overview.data, fit))


def _best(
    contenders: Sequence[Contender],
    options: Options,
    known: tuple[Contender, Fit] | None = None,
) -> tuple[Contender, Fit]:
    """Give the simplest good contender whose fit converges, with that fit; one may be known."""
    remaining = list(contenders)
    while True:
        chosen = simplest_good(remaining)
        if known is not None and chosen is known[0]:
            return known
        fit = _final_fit(chosen.family, chosen.overview, chosen.candidate.plays, options)
        if fit.solution.status == CONVERGED or len(remaining) == 1:
            return chosen, fit
        remaining.remove(chosen)


def _only(task: Task, ruling: Ruling, options: Options) -> _Choice:
    """Fit the only family and size there is; the other signs of its weights may be a rival."""
    family, overview = ruling.families[0]
    fit = options.converged(_final_fit(family, overview, family.sizes()[0], options))
    judged = fit.parametrization.free_count < fewest_left(overview)
    if not ruling.others or not judged:
        return _Choice(fit, task, (), (), ())
    chosen = contender_of(family, overview, fit)
    rivals = rivals_of(chosen, fit, (chosen,), other_signs(ruling, chosen))
    return _Choice(fit, task, (), about_the_choice(chosen, (), rivals, task.scales[1]), rivals.fits)


def _outlying(task: Task, options: Options) -> tuple[str, ...]:
    """Say which samples were left out of the fit for being far from every model."""
    if task.family.depends_on_rate:
        return ()
    kept = Overview(task.data, options.delay).kept
    if kept is None:
        return ()
    return (
        f"{int((~kept).sum())} of {kept.size} samples are far from every model and were neither "
        "fitted nor judged by; the errors given count them",
    )


def _told(contender: Contender, chosen: Contender, tied: bool, scale: float) -> Candidate:
    """Give a candidate in the user's units, and say whether it was chosen."""
    candidate = contender.candidate
    return replace(
        candidate,
        score=candidate.score * scale,
        standard_error=candidate.standard_error * scale,
        chosen=contender is chosen,
        tied=tied,
    )


def _final_fit(family: Family, overview: Overview, size: int, options: Options) -> Fit:
    """Fit from all starts, improve it as the family knows, and without idle parts, but once."""
    options.say(f"final fit: {family.named_size(size)}")
    most = options.max_iterations

    def found() -> Fit:
        fit = best_of_starts(family, overview, size, MOST_STARTS, most)
        fit = family.finish(fit, overview, most)
        return settled(family.simplified(fit, overview, most), overview, most)

    return overview.once(("final fit", family, size, most), found)


def _polished(fit: Fit, task: Task, options: Options) -> Fit:
    """Go on with all samples."""
    options.say("final fit: all samples")
    overview = Overview(
        fit.family.fitted(task.data), options.delay, rates_matter=fit.family.depends_on_rate
    )
    problem = fit.problem(overview.data, overview.kept)
    found = fit.family.solve(problem, fit.solution.theta, options.max_iterations)
    polished = settled(replace(fit, solution=found), overview, options.max_iterations)
    return options.converged(fit.family.simplified(polished, overview, options.max_iterations))


def _in_given_units(fit: Fit, task: Task) -> Parametrization:
    return fit.parametrization.in_units(fit.solution.theta, *task.scales)

"""The delay of a family that describes its records, fitted together with the constants."""

from __future__ import annotations

from dataclasses import replace

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.identification.choice.task import Task
from hyst.identification.families.family import Fit
from hyst.identification.judgement.judge import level_of
from hyst.identification.record_use.overview import Overview
from hyst.identification.result.lateness import Lateness, counts_delay, lateness_of

ROUNDS = 5
SETTLED = 0.1
"""Standard errors: a change of the delay that is worth no further round."""

LARGEST_STEP = 0.5
"""Samples by which one round changes the delay at most; it is linear about where it is."""

SURELY = 3.0
"""Standard errors by which a delay must differ from none, where only this family shows it."""

TWO = 2.0
"""Standard errors either side, of 95 %."""

BETWEEN_SAMPLES = 0.02
"""Samples by which the interval is widened: how the input went between two samples is no record's
to tell, and a cubic says it no better."""

DIGITS = 3
"""Of a delay in samples."""


def with_joint_delay(fit: Fit, task: Task, max_iterations: int) -> tuple[Fit, Task]:
    """Go on from a fit with the delay free as well, where the records showed one.

    It is kept if nothing but noise is left then.

    A delay of 0 that the records do not exclude stays 0, but for families of rates: general loops
    cannot tell a delay from what grows with the rate, so there the family itself says whether there
    is one. A whole delay stays whole while the joint fit does not exclude it.

    Parameters
    ----------
    fit, task
        A final fit and what it was made on.
    max_iterations
        Of each further fit.

    Returns
    -------
    Fit, Task
        With the delay, and the evidence told of it.
    """
    known = task.evidence
    if known is None or not counts_delay(fit.family, known):
        return fit, task
    asks_family = fit.family.depends_on_rate
    if not (task.data.lag or asks_family):
        return fit, task
    before = fit, task
    late = Lateness(0.0, 0.0, *(2 * (fit.solution.theta,)))
    for _ in range(ROUNDS):
        late = _lateness(fit, task)
        if abs(late.change) <= SETTLED * late.error:
            break
        step = min(max(late.change, -LARGEST_STEP), LARGEST_STEP)
        delay = min(max(task.data.lag + step, known.low), known.high)
        if delay == task.data.lag:
            break
        fit, task = _at(delay, fit, task, max_iterations)
    best = min(max(task.data.lag + late.change, known.low), known.high)
    told = _told(best, late.error, asks_family, known)
    fit, task = _at(told, fit, task, max_iterations)
    # Where loops are of another shape the delay may stand in for it.
    if level_of(task.data, fit) != "good" and level_of(before[1].data, before[0]) != "good":
        return before
    return fit, replace(task, evidence=_evidence(told, best, late.error, known))


def _lateness(fit: Fit, task: Task) -> Lateness:
    overview = _overview(fit, task)
    return lateness_of(overview.data, fit, overview.kept)


def _overview(fit: Fit, task: Task) -> Overview:
    data = fit.family.fitted(task.data)
    return Overview(data, rates_matter=fit.family.depends_on_rate)


def _at(delay: float, fit: Fit, task: Task, max_iterations: int) -> tuple[Fit, Task]:
    """Fit again with another delay, from the constants of the one before."""
    if delay == task.data.lag:
        return fit, task
    task = task.delayed(delay, task.evidence)
    overview = _overview(fit, task)
    problem = fit.problem(overview.data, overview.kept)
    solution = fit.family.solve(problem, fit.solution.theta, max_iterations)
    return replace(fit, solution=solution), task


def _told(best: float, error: float, asks_family: bool, known: DelayEvidence) -> float:
    """Give the delay to tell: none, a whole one, or the best."""
    if asks_family and known.low <= 0.0 <= known.high and abs(best) <= SURELY * error:
        return 0
    whole = round(best)
    if whole and abs(best - whole) <= TWO * error and known.low <= whole <= known.high:
        return whole
    return round(best, DIGITS)


def _evidence(told: float, best: float, error: float, known: DelayEvidence) -> DelayEvidence:
    """Say the same of the delay as the joint fit: its interval holds what is told."""
    half = TWO * error + BETWEEN_SAMPLES
    low, high = min(best - half, told), max(best + half, told)
    low, high = round(max(low, -known.limit), DIGITS), round(min(high, known.limit), DIGITS)
    return replace(
        known,
        delay=float(told),
        low=low,
        high=high,
        describes=True,
        excludes_zero=not low <= 0.0 <= high,
        rate_or_lag=known.rate_or_lag and low <= 0.0 <= high,
    )

"""Delay between input and output: what the records show of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.optimize

from hyst.diagnosis.delay_evidence import DelayEvidence, evidence_of_delay
from hyst.identification.choice.fewer_samples import LOOK_SAMPLES
from hyst.identification.families.family import Fit
from hyst.identification.record_use.thinning import MOST_SAMPLES, thinned
from hyst.identification.record_use.used_samples import Data

NOISE_ALIKE = 1.05
"""By how much a residual may exceed the noise and still be called noise."""

NOISE_ALIKE_OF_RATES = 1.25
"""The same of a model of rates, which are differences of samples and known only so well."""

REFIT_ITERATIONS = 10

WHOLE_ALIKE = 1.005
"""By how much more a whole number may leave and still be taken for a number next to it."""

NARROW = 0.1
"""Samples: an interval no wider has nothing to settle."""

LAGS_TRIED = 7

OWN = "own"
"""Where the loops of the family itself tell the delay."""

OWN_LAGS_TRIED, OWN_STEP, OWN_ALIKE = 11, 4, 0.9
"""Of such loops: lags tried at first, how far about one that was found, and the residual, over that
without a lag, up to which one is taken; they may change with the lag as well."""

FAR = 20.0
"""Variance ratio of one constant: noise reaches it once in a hundred thousand times."""


def find_delay(data: Data) -> DelayEvidence:
    """Ask the records for their delay; the delay they already have is ignored.

    Parameters
    ----------
    data
        The records.
    """
    bare = data.delayed(0.0)
    return evidence_of_delay(bare.records, bare.starts, bare.kept)


def usable_delay(evidence: DelayEvidence, data: Data) -> float:
    """Give the delay, cut where it would leave less than half of a record.

    Parameters
    ----------
    evidence
        Of the records.
    data
        The records.
    """
    half = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True)) // 2
    delay = max(-half, min(evidence.delay, half))
    return math.trunc(delay) if float(delay).is_integer() else delay


def told_by_family(data: Data, fit: Fit, evidence: DelayEvidence) -> tuple[float, DelayEvidence]:
    """Let a family that describes the records choose the delay, and say what is known of it then.

    Parameters
    ----------
    data, fit, evidence
        As of ``settled_by_family``.
    """
    if fit.family.loops_tell_delay != OWN:
        return settled_by_family(data, fit, evidence), evidence
    known = _told_by_own_loops(data, fit, evidence)
    return (data.lag, evidence) if known is None else (known.delay, known)


def _told_by_own_loops(data: Data, fit: Fit, evidence: DelayEvidence) -> DelayEvidence | None:
    """Find the lag at which the family leaves least, where it leaves more than noise without.

    Of strokes of one amplitude none is taken: a loop of any width is as good there.
    """
    now, noise = data.delay, evidence.noise_rms or 0.0
    limit = math.floor(evidence.limit)
    costs = {now: _rms_of_searched(data, fit, now)}
    if limit < 1 or costs[now] <= NOISE_ALIKE * noise:
        return None
    if evidence.one_amplitude:
        return evidence.undecided() if now else None
    step = math.ceil(2 * limit / (OWN_LAGS_TRIED - 1))
    first = np.linspace(-limit, limit, OWN_LAGS_TRIED).tolist()
    if now:  # found before, on a grid that was made for another lag
        step, first = OWN_STEP, [0, now - OWN_STEP, now + OWN_STEP]
    elif not _promises(data, fit, [round(each) for each in first]):
        return None
    for lag in {round(each) for each in first if abs(each) <= limit} - {now}:
        costs[lag] = _rms_of_searched(data, fit, lag)
    while step > 1:
        step = (step + 1) // 2
        best = min(costs, key=costs.__getitem__)
        for lag in (best - step, best + step):
            if abs(lag) <= limit and lag not in costs:
                costs[lag] = _rms_of_searched(data, fit, lag)
    best = min(costs, key=costs.__getitem__)
    least = costs[best]
    without = costs.get(0, math.inf)
    if best == now:
        return None
    if least > OWN_ALIKE * without or not _far_better(least, without, data):
        return evidence.undecided() if now else None
    worse = [lag for lag, cost in costs.items() if _far_better(least, cost, data)]
    return replace(
        evidence,
        delay=float(best),
        low=float(max((lag for lag in worse if lag < best), default=-limit)),
        high=float(min((lag for lag in worse if lag > best), default=limit)),
        excludes_zero=True,
        rate_or_lag=False,
    )


def _promises(data: Data, fit: Fit, lags: Sequence[int]) -> bool:
    """Tell on few samples whether any of some lags leaves less than none."""
    few = (_rms_of_searched(data, fit, lag, LOOK_SAMPLES) for lag in lags if lag)
    return min(few, default=math.inf) < _rms_of_searched(data, fit, 0, LOOK_SAMPLES)


def _rms_of_searched(data: Data, fit: Fit, lag: int, most: int = MOST_SAMPLES) -> float:
    searched = thinned(fit.family.searched(data.delayed(lag)), most)
    problem = fit.problem(searched)
    theta = fit.family.solve(problem, fit.solution.theta, REFIT_ITERATIONS).theta
    residual = problem.residual(theta)[: searched.measured().size]
    return math.sqrt(float(residual @ residual) / residual.size)


def settled_by_family(data: Data, fit: Fit, evidence: DelayEvidence) -> float:
    """Let a family that describes the records choose among the delays that are possible.

    Loops that are general leave several delays possible; a family with few constants may tell them
    apart, but only one that leaves nothing but noise has a say.

    Parameters
    ----------
    data
        The records with the delay found so far.
    fit
        The family fitted to them.
    evidence
        Of the records; where it holds 0, and not because of their rates, or one whole delay alone,
        nothing is settled.

    Returns
    -------
    float
    """
    if fit.family.depends_on_rate and not fit.family.answers_late:
        return _settled_by_rates(data, fit, evidence)
    possible = range(math.ceil(evidence.low), math.floor(evidence.high) + 1)
    open_question = evidence.excludes_zero or evidence.rate_or_lag
    part = not float(data.lag).is_integer()
    if part or not open_question or len(possible) < 2 or not evidence.noise_rms:
        return data.lag
    best, least = data.delay, _rms(data, fit, data.delay)
    for step in (-1, 1):
        delay = data.delay + step
        while delay in possible:
            error = _rms(data, fit, delay)
            if error >= least:
                break
            best, least, delay = delay, error, delay + step
    most = NOISE_ALIKE * evidence.noise_rms
    if least <= most:
        return best
    return _between_whole(data, fit, evidence, best, most) if evidence.rate_or_lag else data.lag


def _between_whole(data: Data, fit: Fit, evidence: DelayEvidence, about: int, most: float) -> float:
    """Give a delay next to a whole one with which nothing but noise is left; else the one so far.

    Where records at several rates show a lag, general loops have taken none.
    """
    ends = (max(evidence.low, about - 1.0), min(evidence.high, about + 1.0))
    if ends[1] - ends[0] < NARROW:
        return data.lag
    found = scipy.optimize.minimize_scalar(
        lambda lag: _rms(data, fit, float(lag)),
        bounds=ends,
        method="bounded",
        options={"xatol": 0.02, "maxiter": 10},
    )
    return round(float(found.x), 3) if found.fun <= most else data.lag


def _settled_by_rates(data: Data, fit: Fit, evidence: DelayEvidence) -> float:
    """Let plays whose width follows the rate find the lag of records at several rates.

    Without it a lag of part of a sample passes for rate: both grow with the frequency. It is taken
    if it leaves nothing but noise, and where that is far better than without it.
    """
    low, high = evidence.low, evidence.high
    if high - low < NARROW or not evidence.noise_rms:
        return data.lag
    without = _rms(data, fit, data.lag)

    def cost(lag: float) -> float:
        return _rms(data, fit, lag)

    tried = np.linspace(low, high, max(LAGS_TRIED, math.ceil(high - low) + 1))
    costs = [cost(float(lag)) for lag in tried]
    at = int(np.argmin(costs))
    around = (float(tried[max(at - 1, 0)]), float(tried[min(at + 1, tried.size - 1)]))
    found = scipy.optimize.minimize_scalar(
        cost, bounds=around, method="bounded", options={"xatol": 0.01, "maxiter": 12}
    )
    best, least = float(found.x), float(found.fun)
    whole = float(round(best))
    for simpler, alike in ((float(data.lag), 1.0), (whole, WHOLE_ALIKE)):
        if low <= simpler <= high and not _far_better(least, cost(simpler) / alike, data):
            best, least = simpler, cost(simpler)
            break
    if least > NOISE_ALIKE_OF_RATES * evidence.noise_rms or not _far_better(least, without, data):
        return data.lag
    return int(best) if best.is_integer() else round(best, 3)


def _far_better(least: float, other: float, data: Data) -> bool:
    """Tell whether one more constant lowers the squared error by more than noise may."""
    samples = data.measured().size
    return (other**2 - least**2) * samples > FAR * max(least, np.finfo(float).tiny) ** 2


def _rms(data: Data, fit: Fit, delay: float) -> float:
    """Fit the family to thinned records, but judge it by all samples.

    Thinned records hold other samples of the noise at every delay, which would decide.
    """
    shifted = data.delayed(delay)
    searched = shifted if fit.family.depends_on_rate else thinned(shifted)
    theta = fit.family.solve(fit.problem(searched), fit.solution.theta, REFIT_ITERATIONS).theta
    residual = fit.problem(shifted).residual(theta)
    return math.sqrt(float(residual @ residual) / residual.size)

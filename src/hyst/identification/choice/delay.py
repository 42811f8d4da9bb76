"""Delay between input and output: what the records show of it."""

from __future__ import annotations

import math

from hyst.diagnosis.delay_evidence import DelayEvidence, evidence_of_delay
from hyst.identification.families.family import Fit
from hyst.identification.record_use.thinning import thinned
from hyst.identification.record_use.used_samples import Data

NOISE_ALIKE = 1.05
"""By how much a residual may exceed the noise and still be called noise."""

REFIT_ITERATIONS = 10


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
    return best if least <= NOISE_ALIKE * evidence.noise_rms else data.lag


def _rms(data: Data, fit: Fit, delay: float) -> float:
    """Fit the family to thinned records, but judge it by all samples.

    Thinned records hold other samples of the noise at every delay, which would decide.
    """
    shifted = data.delayed(delay)
    searched = shifted if fit.family.depends_on_rate else thinned(shifted)
    theta = fit.family.solve(fit.problem(searched), fit.solution.theta, REFIT_ITERATIONS).theta
    residual = fit.problem(shifted).residual(theta)
    return math.sqrt(float(residual @ residual) / residual.size)

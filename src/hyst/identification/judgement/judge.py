"""The verdict on a fit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from hyst.diagnosis import Diagnosis
from hyst.identification.families.family import Fit
from hyst.identification.judgement.causes.rate import RATE
from hyst.identification.judgement.found_before import FoundBefore, found_before
from hyst.identification.judgement.left_over import Told, causes_of, is_too_short, told_of
from hyst.identification.judgement.remainder import Remainder, remainder_of
from hyst.identification.judgement.taken_apart import SMALLEST_PART, TakenApart, taken_apart
from hyst.identification.judgement.unfit import reasons_unfit
from hyst.identification.judgement.validation import Validation, validated
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Verdict
from hyst.operators.verdict import LEVELS, Level
from hyst.signals import Metrics

NOTHING_TOLD = Told((), ())


def judge(data: Data, fit: Fit, diagnosis: Diagnosis, metrics: Mapping[str, Metrics]) -> Verdict:
    """Say how far a fit can be trusted, why, what it leaves, and what to do.

    ``good``: what is left is the record's own noise, or less than 0.05 % of the output's range.
    ``unfit``: more than 8 % of the range is left beside noise, or hardly less than a straight line
    or the mean leave. Else ``fair``. A finding of the severity ``warning``, unless the family
    explains it, and a validation error far above that of training, allow no better than ``fair``.

    Parameters
    ----------
    data
        The records as they were used.
    fit
        The final fit, in their units.
    diagnosis
        What the records showed before any model.
    metrics
        Errors by record, validation included.

    Returns
    -------
    Verdict
    """
    remainder = remainder_of(data, fit, metrics["training"].output_range)
    error = math.sqrt(float(np.mean(remainder.error**2)))
    if error <= SMALLEST_PART * remainder.output_range:
        level, first, told = _exact(remainder, error)
        noise = error
    else:
        found = taken_apart(remainder)
        level, first, told = _levelled(remainder, found, error)
        noise = found.noise
    told = replace(told, advice=tuple(_for_family(each, fit) for each in told.advice))
    seen = validated(metrics, noise * remainder.output_scale, remainder.output_unit)
    before = found_before(diagnosis, data, fit.family, leaves_noise=level == "good")
    return _capped(level, first, told, before, seen)


def _for_family(advice: str, fit: Fit) -> str:
    """Give other advice to a family that depends on the rate as it is."""
    return fit.family.about_rates or advice if advice == RATE.advice else advice


def level_of(data: Data, fit: Fit) -> Level:
    """Judge a fit by what it leaves alone: ``good`` if that is noise or not worth a word.

    Parameters
    ----------
    data
        The records.
    fit
        The fit, in their units.
    """
    span = max(float(np.ptp(each.y)) for each in data.records)
    remainder = remainder_of(data, fit, span)
    error = math.sqrt(float(np.mean(remainder.error**2)))
    if error <= SMALLEST_PART * remainder.output_range:
        return "good"
    return _levelled(remainder, taken_apart(remainder), error)[0]


def _exact(remainder: Remainder, error: float) -> tuple[Level, tuple[str, ...], Told]:
    first = (
        f"The model leaves {remainder.said(error)} rms: nothing worth a name, and no more than "
        "rounding or a very quiet sensor would."
    )
    return "good", (first,), NOTHING_TOLD


def _levelled(
    remainder: Remainder, found: TakenApart, error: float
) -> tuple[Level, tuple[str, ...], Told]:
    """Give level, the reason for it, and what is left."""
    reasons = reasons_unfit(remainder, found)
    if reasons:
        return "unfit", reasons, causes_of(found)
    told = told_of(remainder, found)
    if told.left:
        more = (
            f"more than the record's own noise of {remainder.said(found.noise)}"
            if found.is_noise
            else "which is not noise alone"
        )
        if is_too_short(remainder, found):
            more = "of which the record is too short to tell what it is"
        return "fair", (f"The model leaves {remainder.said(error)} rms, {more}.",), told
    how = (
        "it is as large from one repetition of the drive to the next"
        if found.period_known
        else "it follows neither the drive, nor its rate, nor time"
    )
    first = f"What the model leaves, {remainder.said(error)} rms, is the record's own noise: {how}."
    return "good", (first,), told


def _capped(
    level: Level,
    first: tuple[str, ...],
    told: Told,
    before: FoundBefore,
    seen: Validation,
) -> Verdict:
    """Lower the level to what findings and validation allow, and put the sentences in order."""
    worst = max(level, seen.level, before.level, key=LEVELS.index)
    own = first + told.left
    if level == "unfit":
        sentences = own + seen.sentences + before.sentences
    elif level == worst and not seen.sentences:
        sentences = own + before.sentences
    else:
        sentences = seen.sentences + before.sentences + own
    return Verdict(worst, sentences + tuple(dict.fromkeys(before.advice + told.advice)))

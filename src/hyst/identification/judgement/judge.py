"""The verdict on a fit."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from hyst.diagnosis import Diagnosis
from hyst.identification.families.family import Fit
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
    seen = validated(metrics, noise * remainder.output_scale, remainder.output_unit)
    explained = fit.family.explains if level == "good" else ()
    return _capped(level, first, told, diagnosis, seen, explained)


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
    diagnosis: Diagnosis,
    seen: Validation,
    explained: tuple[str, ...],
) -> Verdict:
    """Lower the level to what findings and validation allow, and put the sentences in order."""
    warnings = tuple(
        f"The record itself is doubtful ({each.name}): {each.sentence}"
        for each in diagnosis.of("warning")
        if each.name not in explained
    )
    allowed: Level = "fair" if warnings else "good"
    worst = max(level, seen.level, allowed, key=LEVELS.index)
    own = first + told.left
    if level == "unfit":
        sentences = own + seen.sentences + warnings
    elif level == worst and not seen.sentences:
        sentences = own + warnings
    else:
        sentences = seen.sentences + warnings + own
    return Verdict(worst, sentences + told.advice)

"""The verdict on a fit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hyst.diagnosis import Diagnosis
from hyst.identification.families.family import Fit
from hyst.identification.judgement.falling_output import falling_share
from hyst.identification.judgement.remainder import Remainder, remainder_of
from hyst.identification.judgement.taken_apart import (
    SMALLEST_PART,
    SMALLEST_SHARE,
    TakenApart,
    taken_apart,
)
from hyst.identification.judgement.validation import Validation, validated
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Verdict
from hyst.operators.verdict import LEVELS, Level
from hyst.signals import Metrics

FAR_OFF = 0.08
"""Rms of what is left beside noise, over the output's range: no command comes from such a model."""

OFF = 0.04
"""The same, of a model that has other signs of being none."""

LIKE_A_LINE = 0.7
"""Of what a straight line leaves beside noise: a model with memory that leaves more is no better."""

OPEN_LOOP = 5e-3
"""Of the output's range, what a line must leave beside noise for a loop to be missed."""

LIKE_THE_MEAN = 0.9
"""Of the deviation from the mean: a model that leaves more knows nothing of the output."""

AGAINST = 0.15
"""Share of the output's way against its main direction, from which it is told."""

HELD = 0.5
"""Share of the constants on bounds."""

CORRELATED = 4.0
"""Samples of noise that count as one, from which noise of unknown repetition is told."""


@dataclass(frozen=True)
class _Sizes:
    """Rms of what is left, in shares of the output's range."""

    left: float
    beside_noise: float
    line_beside_noise: float
    mean: float
    bias: float


def judge(data: Data, fit: Fit, diagnosis: Diagnosis, metrics: Mapping[str, Metrics]) -> Verdict:
    """Say how far a fit can be trusted, why, what it leaves, and what to do.

    ``good``: what is left is the record's own noise, or less than 0.05 % of the output's range.
    ``unfit``: more than 8 % of the range is left beside noise, or hardly less than a straight line
    or the mean leave. Else ``fair``. A finding of the severity ``warning``, and a validation error
    far above that of training, allow no better than ``fair``.

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
    found = None
    if error > SMALLEST_PART * remainder.output_range:
        found = taken_apart(remainder)
    noise = (error if found is None else found.noise) * remainder.output_scale
    seen = validated(metrics, noise, remainder.output_unit)
    if found is None:
        exact = (
            f"The model leaves {remainder.said(error)} rms: nothing worth a name, and no more "
            "than rounding or a very quiet sensor would.",
        )
        return _capped("good", exact, (), (), diagnosis, seen)
    sizes = _sizes(remainder, found, error)
    reasons = _unfit(remainder, fit, sizes)
    left, advice = _left(remainder, found, sizes)
    if reasons:
        return _capped("unfit", reasons, left, advice, diagnosis, seen)
    if left:
        return _capped("fair", (_fair(remainder, found, error),), left, advice, diagnosis, seen)
    return _capped("good", (_good(remainder, found, error),), (), (), diagnosis, seen)


def _sizes(remainder: Remainder, found: TakenApart, error: float) -> _Sizes:
    span, noise = remainder.output_range, found.noise

    def beside(rms: float) -> float:
        return math.sqrt(max(rms**2 - noise**2, 0.0)) / span

    return _Sizes(
        error / span,
        beside(found.undisturbed),
        beside(found.line),
        float(np.std(remainder.y)) / span,
        abs(float(np.mean(remainder.error))) / span,
    )


def _unfit(remainder: Remainder, fit: Fit, sizes: _Sizes) -> tuple[str, ...]:
    """Give the reasons why no command should come from the model."""
    percent = f"{100.0 * sizes.left:.2g} % of the output's range rms"
    reasons = []
    if sizes.left > LIKE_THE_MEAN * sizes.mean:
        reasons.append(
            f"The output hardly follows the input: the model leaves {percent}, its mean "
            f"{100.0 * sizes.mean:.2g} %."
        )
    elif sizes.beside_noise > FAR_OFF:
        reasons.append(f"The model does not describe the record: it leaves {percent}.")
    elif (
        remainder.has_memory
        and sizes.line_beside_noise > OPEN_LOOP
        and sizes.beside_noise > LIKE_A_LINE * sizes.line_beside_noise
    ):
        reasons.append(
            f"The model is hardly better than a straight line: it leaves {percent}, a line "
            f"{100.0 * math.hypot(sizes.line_beside_noise, _noise(sizes)):.2g} %."
        )
    elif sizes.beside_noise > OFF and remainder.held >= HELD:
        reasons.append(
            f"The model leaves {percent}, and {100.0 * remainder.held:.0f} % of its constants lie "
            "on their bounds: it is of another kind than the actuator."
        )
    if reasons:
        against = falling_share(remainder)
        if against > AGAINST:
            reasons.append(
                f"The output runs against its main direction on {100.0 * against:.0f} % of its "
                "way: it falls where the input rises, as strain of a bipolar drive does (a "
                "butterfly), and no family has such loops."
            )
        reasons.append("No command should come from it.")
    return tuple(reasons)


def _noise(sizes: _Sizes) -> float:
    return math.sqrt(max(sizes.left**2 - sizes.beside_noise**2, 0.0))


def _fair(remainder: Remainder, found: TakenApart, error: float) -> str:
    white = found.period_known or found.correlation <= CORRELATED
    what = "is the record's own noise" if white else "has no name"
    return (
        f"The model leaves {remainder.said(error)} rms, of which {remainder.said(found.noise)} "
        f"{what}; the rest is told here."
    )


def _good(remainder: Remainder, found: TakenApart, error: float) -> str:
    how = (
        "it is as large where the drive repeats"
        if found.period_known
        else "it follows neither the drive, nor its rate, nor time"
    )
    return f"What the model leaves, {remainder.said(error)} rms, is the record's own noise: {how}."


def _left(
    remainder: Remainder, found: TakenApart, sizes: _Sizes
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Say what is left beside noise, and what to do about it."""
    left = [cause.sentence(told) for cause, told in found.named]
    advice = [cause.advice for cause, _ in found.named]
    count, share = found.outliers
    if count and share >= SMALLEST_SHARE:
        some = f"{count} samples lie" if count > 1 else "One sample lies"
        left.append(
            f"{some} far from the others and make {100.0 * share:.0f} % of the squared error."
        )
        advice.append("Look at the outliers, and leave them out if they are no measurements.")
    if sizes.bias > max(math.sqrt(SMALLEST_SHARE) * sizes.left, SMALLEST_PART):
        bias = remainder.said(sizes.bias * remainder.output_range)
        left.append(f"The model's zero is off by {bias}.")
        advice.append("Let the model's offset be free, or take the zero of the sensor out.")
    if found.repeats:
        left.append(
            f"Something without a name repeats with the drive: {remainder.said(found.repeats)} rms."
        )
        advice.append("Try other families (--family auto), or dynamics (--family hammerstein).")
    elif not found.period_known and found.correlation > CORRELATED and not found.named:
        left.append(
            f"What is left, {remainder.said(found.noise)} rms, keeps its value over some "
            f"{found.correlation:.0f} samples, and nothing it follows has been found."
        )
        advice.append(
            "Drive the same cycle several times: it tells noise from what the model lacks."
        )
    return tuple(left), tuple(advice)


def _capped(
    level: Level,
    first: tuple[str, ...],
    left: tuple[str, ...],
    advice: tuple[str, ...],
    diagnosis: Diagnosis,
    seen: Validation,
) -> Verdict:
    """Lower the level to what findings and validation allow, and put the sentences in order."""
    warnings = tuple(
        f"The record itself is doubtful ({each.name}): {each.sentence}"
        for each in diagnosis.of("warning")
    )
    allowed: Level = "fair" if warnings else "good"
    worst = max(level, seen.level, allowed, key=LEVELS.index)
    above = seen.sentences + warnings
    told = (*first, *left, *above) if level == worst else (*above, *first, *left)
    return Verdict(worst, (*told, *dict.fromkeys(advice)))

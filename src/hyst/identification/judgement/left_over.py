"""What a fit leaves beside noise, in sentences, and what to do about it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hyst.identification.judgement.causes.rate import RATE
from hyst.identification.judgement.growth_with_rate import growth_with_rate
from hyst.identification.judgement.remainder import Remainder
from hyst.identification.judgement.taken_apart import SMALLEST_PART, SMALLEST_SHARE, TakenApart

FEWEST_SAMPLES = 200
"""Some eight for each column of general loops: with less, a misfit is easily missed."""

NOT_SMALL = 0.01
"""Of the output's range: where a short record leaves less, that is no matter."""

MOST_CAUSES = 3
"""Told: further ones are small beside them, and their names the less certain."""


NOT_FOUND = (
    "nothing it follows has been found: it may be the sensor's noise, or what the model lacks."
)
SAME_CYCLE = "Drive the same cycle several times: it tells noise from what the model lacks."


@dataclass(frozen=True)
class Told:
    """What is left, and what to do.

    Parameters
    ----------
    left, advice
        Sentences; both empty where only noise is left.
    """

    left: tuple[str, ...]
    advice: tuple[str, ...]


def causes_of(found: TakenApart) -> Told:
    """Say by what causes a fit leaves what it leaves."""
    named = found.named[:MOST_CAUSES]
    return Told(
        tuple(cause.sentence(told) for cause, told in named),
        tuple(cause.advice for cause, _ in named),
    )


def told_of(remainder: Remainder, found: TakenApart) -> Told:
    """Say what a fit leaves beside noise, with or without a name.

    Parameters
    ----------
    remainder, found
        What the fit leaves, and the same taken apart.
    """
    causes = causes_of(found)
    pairs = [
        *_by_rate(remainder, found),
        *_too_short(remainder, found),
        *_outliers(found),
        *_bias(remainder),
        *_without_name(remainder, found),
    ]
    left, advice = (tuple(pair[i] for pair in pairs) for i in (0, 1))
    return Told(causes.left + left, tuple(dict.fromkeys(causes.advice + advice)))


def _by_rate(remainder: Remainder, found: TakenApart) -> list[tuple[str, str]]:
    if any(cause is RATE for cause, _ in found.named):
        return []
    growth = growth_with_rate(remainder)
    return [(growth, RATE.advice)] if growth else []


def is_too_short(remainder: Remainder, found: TakenApart) -> bool:
    """Tell whether a record is too short to tell noise from what a model lacks.

    Parameters
    ----------
    remainder, found
        What the fit leaves, and the same taken apart.
    """
    error = math.sqrt(float(np.mean(remainder.error**2)))
    matters = error >= NOT_SMALL * remainder.output_range
    return remainder.error.size < FEWEST_SAMPLES and matters and not found.named


def _too_short(remainder: Remainder, found: TakenApart) -> list[tuple[str, str]]:
    if not is_too_short(remainder, found):
        return []
    return [
        (
            f"With {remainder.error.size} samples, noise and what the model lacks cannot be told "
            "apart.",
            "Record more samples, and the same cycle several times.",
        )
    ]


def _outliers(found: TakenApart) -> list[tuple[str, str]]:
    count, share = found.outliers
    if not count or share < SMALLEST_SHARE:
        return []
    some = f"{count} samples lie" if count > 1 else "One sample lies"
    makes = "make" if count > 1 else "makes"
    return [
        (
            f"{some} far from the others and {makes} {100.0 * share:.0f} % of the squared error.",
            "Look at the outliers, and leave them out if they are no measurements.",
        )
    ]


def _bias(remainder: Remainder) -> list[tuple[str, str]]:
    bias = float(np.mean(remainder.error))
    left = math.sqrt(float(np.mean(remainder.error**2)))
    span = remainder.output_range
    if abs(bias) <= max(math.sqrt(SMALLEST_SHARE) * left, SMALLEST_PART * span):
        return []
    return [
        (
            f"The model's zero is off by {remainder.said(abs(bias))}.",
            "Let the model's offset be free, or take the zero of the sensor out.",
        )
    ]


def _without_name(remainder: Remainder, found: TakenApart) -> list[tuple[str, str]]:
    if found.repeats:
        return [
            (
                "Something without a name repeats with the drive: "
                f"{remainder.said(found.repeats)} rms.",
                "Try families that were not compared yet, or dynamics (--family hammerstein).",
            )
        ]
    smallest = SMALLEST_PART * remainder.output_range
    error = math.sqrt(float(np.mean(remainder.error**2)))
    if found.is_noise or found.noise < max(math.sqrt(SMALLEST_SHARE) * error, smallest):
        return []
    return [
        (
            f"What then is left, {remainder.said(found.noise)} rms, is not white, and {NOT_FOUND}",
            SAME_CYCLE,
        )
    ]

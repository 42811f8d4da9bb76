"""What a fit leaves beside noise, in sentences, and what to do about it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hyst.identification.judgement.remainder import Remainder
from hyst.identification.judgement.taken_apart import SMALLEST_PART, SMALLEST_SHARE, TakenApart

MOST_CAUSES = 3
"""Told: further ones are small beside them, and their names the less certain."""


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


def told_of(remainder: Remainder, found: TakenApart) -> Told:
    """Say what a fit leaves beside noise.

    Parameters
    ----------
    remainder, found
        What the fit leaves, and the same taken apart.
    """
    pairs = [(cause.sentence(told), cause.advice) for cause, told in found.named[:MOST_CAUSES]]
    pairs += [*_outliers(found), *_bias(remainder), *_without_name(remainder, found)]
    return Told(
        tuple(left for left, _ in pairs), tuple(dict.fromkeys(advice for _, advice in pairs))
    )


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
                "Try other families (--family auto), or dynamics (--family hammerstein).",
            )
        ]
    if found.is_noise or found.noise < SMALLEST_PART * remainder.output_range:
        return []
    return [
        (
            f"What then is left, {remainder.said(found.noise)} rms, is not white, and nothing it "
            "follows has been found: it may be the sensor's noise, or what the model lacks.",
            "Drive the same cycle several times: it tells noise from what the model lacks.",
        )
    ]

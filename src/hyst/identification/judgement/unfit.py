"""Reasons why no command should come from a model."""

from __future__ import annotations

import math

from hyst.identification.judgement.causes.change import CHANGE
from hyst.identification.judgement.falling_output import falling_share, follows_the_speed
from hyst.identification.judgement.remainder import Remainder
from hyst.identification.judgement.taken_apart import TakenApart

FAR_OFF = 0.08
"""Rms of what is left beside noise, over the output's range: such a model describes nothing."""

OFF = 0.04
"""The same, of a model that has another sign of being none."""

LIKE_A_LINE = 0.7
"""Of what a straight line leaves beside noise: with more, a model with memory is no better."""

OPEN_LOOP = 0.02
"""Of the output's range, what a line must leave beside noise for a loop to be missed."""

WORSE = 1.2
"""Of what a straight line leaves beside noise: with more, no memory makes up for what is missed."""

LIKE_THE_MEAN = 0.9
"""Of the deviation from the mean: a model that leaves more knows nothing of the output."""

SEVERAL = 0.02
"""Rms of a change on the way, over the output's range, from which it is two actuators."""

HELD = 0.5
"""Share of the constants on bounds."""

AGAINST = 0.15
"""Share of the output's way against its main direction, from which it is told."""


def reasons_unfit(remainder: Remainder, found: TakenApart) -> tuple[str, ...]:
    """Say why no command should come from a model; nothing where one may.

    Parameters
    ----------
    remainder, found
        What the fit leaves, and the same taken apart.
    """
    reason = _reason(remainder, found)
    if not reason:
        return ()
    against = falling_share(remainder)
    if follows_the_speed(remainder):
        return (
            f"No command should come from this model. {reason} The output follows the speed of the "
            "input more than the input, as a damper's force does: give the speed as the input.",
        )
    if against > AGAINST and beside_noise(found, found.undisturbed) > OFF * remainder.output_range:
        reason += (
            f" The output runs against its main direction on {100.0 * against:.0f} % of its way: "
            "it falls where the input rises, as strain of a bipolar drive does (a butterfly). Only "
            "family 'butterfly' has such loops; or keep the drive on one side of where the output "
            "turns."
        )
    return (f"No command should come from this model. {reason}",)


def beside_noise(found: TakenApart, rms: float) -> float:
    """Give the part of an rms that is not the record's own noise.

    Parameters
    ----------
    found
        With the noise.
    rms
        Of all that is left.
    """
    return math.sqrt(max(rms**2 - found.sensor**2, 0.0))


def _reason(remainder: Remainder, found: TakenApart) -> str:
    span = remainder.output_range
    left = beside_noise(found, found.undisturbed)
    line = beside_noise(found, found.line)
    leaves = f"it leaves {remainder.said(found.undisturbed)} rms"
    if found.undisturbed > LIKE_THE_MEAN * found.spread:
        return (
            f"The output hardly follows the input: the mean leaves {remainder.said(found.spread)} "
            f"rms, and the model {remainder.said(found.undisturbed)}."
        )
    if left > FAR_OFF * span:
        return f"It does not describe the record: {leaves}."
    if any(cause is CHANGE and told.rms > SEVERAL * span for cause, told in found.named):
        return (
            "The record is of two actuators, one after the other, or of one that changed, and the "
            f"model is none of both: {leaves}."
        )
    if remainder.has_memory and line > OPEN_LOOP * span and left > LIKE_A_LINE * line:
        return (
            f"It is hardly better than a straight line: {leaves}, a line "
            f"{remainder.said(found.line)}."
        )
    if remainder.has_memory and left > max(WORSE * line, OPEN_LOOP * span):
        return (
            f"A straight line describes the record better: {leaves}, a line "
            f"{remainder.said(found.line)}."
        )
    if left > OFF * span and follows_the_speed(remainder):
        return f"It is no hysteresis that it should describe: {leaves}."
    if left > OFF * span and remainder.held >= HELD:
        return (
            f"It is of another kind than the actuator: {leaves}, and "
            f"{100.0 * remainder.held:.0f} % of its constants lie on their bounds."
        )
    return ""

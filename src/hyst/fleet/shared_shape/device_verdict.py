"""The verdict on a device that was identified by the shape of its fleet."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.regression import is_white
from hyst.identification.judgement.taken_apart import SMALLEST_PART
from hyst.identification.judgement.unfit import FAR_OFF, LIKE_A_LINE, OPEN_LOOP, WORSE
from hyst.operators import Verdict
from hyst.operators.verdict import Level

Array = NDArray[np.float64]

UNLIKELY = 1e-5
"""Probability below which a device is none of the population."""

MATTERS = 0.01
"""Of the output's range: what a device of another kind leaves beyond it makes it unfit."""

NOISIER = 1.5
"""Times the noise of the fleet, from which it is told."""

DRAWN = 1.25
"""Times what a device's own constants leave, from which it is told."""

UNSURE = 0.01
"""Of the output's range: a larger predicted error is told."""

FEW = 3.0
"""Samples that count as one, for each constant of the shape: with less, the fleet says most."""


@dataclass(frozen=True, eq=False)
class Seen:
    """What a record shows of its device.

    Parameters
    ----------
    u, error
        Shape (n,), drive and what the device's model leaves, output units.
    y_range
        Range of its output.
    own
        Rms of what its own best constants of the shape leave.
    fleet
        Typical rms of the same in the fleet.
    lacking
        Rms of what the shape lacks in the fleet.
    predicted
        Rms error of the output that is to be expected.
    line
        Rms of what a straight line leaves.
    distance, chance
        From the population, and the probability that one of its devices lies as far.
    noise_chance
        Probability that one of its devices leaves as much.
    has_population
        Whether there is one.
    unit
        Of the output.
    """

    u: Array
    error: Array
    y_range: float
    own: float
    fleet: float
    lacking: float
    predicted: float
    line: float
    distance: float
    chance: float
    noise_chance: float
    has_population: bool
    unit: str

    @property
    def rms(self) -> float:
        """Of what the model leaves."""
        return math.sqrt(float(np.mean(self.error**2)))

    def said(self, amount: float) -> str:
        """Say an amount of output with its share of the range."""
        unit = f" {self.unit}" if self.unit else ""
        return f"{amount:.3g}{unit} ({100.0 * amount / self.y_range:.2g} % of the output's range)"


def judge_device(seen: Seen) -> Verdict:
    """Say how far the model of a device can be trusted, in the words of identification.

    Parameters
    ----------
    seen
        What its record shows.
    """
    white = is_white(seen.error)
    outside = _outside(seen, white)
    reason = _unfit(seen, outside, white)
    if reason:
        return Verdict("unfit", (f"No command should come from this model. {reason}", *outside))
    told = outside + _drawn(seen) + _noisier(seen, white) + _left(seen, white) + _unsure(seen)
    level: Level = "fair" if told else "good"
    first = f"The model leaves {seen.said(seen.rms)} rms"
    if not told:
        how = "as it does of the fleet" if seen.has_population else "its record's own noise"
        first += f", {how}."
    else:
        first += "."
    return Verdict(level, (first, *told))


def _outside(seen: Seen, white: bool) -> tuple[str, ...]:
    """Say that a device is none of the population."""
    if not seen.has_population:
        return ()
    if seen.chance < UNLIKELY:
        return (
            f"It is no device of this fleet: it lies {seen.distance:.3g} times as far from the "
            f"middle of the fleet as half of its devices do (probability {seen.chance:.1g}), so "
            "its constants must not be drawn there; identify it from a longer record of its own.",
        )
    if seen.noise_chance < UNLIKELY and seen.own > NOISIER * seen.fleet and not white:
        return (
            f"Its loop is of another shape than the fleet's: the best constants leave "
            f"{seen.said(seen.own)} rms, of a device of the fleet {seen.said(seen.fleet)}; "
            "identify it by itself.",
        )
    return ()


def _unfit(seen: Seen, outside: tuple[str, ...], white: bool) -> str:
    noise = seen.own if white else min(seen.own, seen.fleet)
    beside = math.sqrt(max(seen.rms**2 - noise**2, 0.0))
    leaves = f"it leaves {seen.said(seen.rms)} rms"
    if beside > FAR_OFF * seen.y_range:
        return f"It does not describe the record: {leaves}."
    if seen.line > OPEN_LOOP * seen.y_range and beside > LIKE_A_LINE * seen.line:
        return f"It is hardly better than a straight line: {leaves}."
    if beside > max(WORSE * seen.line, OPEN_LOOP * seen.y_range):
        return f"A straight line describes the record better: {leaves}."
    if seen.predicted > FAR_OFF * seen.y_range:
        return (
            f"The record says too little of the device: an error of {seen.said(seen.predicted)} "
            "rms is to be expected; record a larger part of the loop."
        )
    if outside and beside > MATTERS * seen.y_range:
        return f"It is of another kind than the fleet: {leaves}."
    return ""


def _drawn(seen: Seen) -> tuple[str, ...]:
    """Say that the device's own constants would do clearly better."""
    if seen.rms <= DRAWN * seen.own or seen.rms <= SMALLEST_PART * seen.y_range:
        return ()
    return (
        f"Constants of its own would leave {seen.said(seen.own)} rms: the fleet draws them too "
        "far, or the search stopped early; identify it from a longer record.",
    )


def _noisier(seen: Seen, white: bool) -> tuple[str, ...]:
    is_noisier = seen.noise_chance < UNLIKELY and seen.own > NOISIER * seen.fleet
    if not seen.has_population or not is_noisier or not white:
        return ()
    return (
        f"Its output is {seen.own / seen.fleet:.2g} times as noisy as those of the fleet: look at "
        "its sensor.",
    )


def _left(seen: Seen, white: bool) -> tuple[str, ...]:
    """Say that something is left beside noise, of the fleet's shape or of this device alone."""
    smallest = SMALLEST_PART * seen.y_range
    if seen.has_population:
        if seen.lacking <= smallest:
            return ()
        return (
            f"The shape lacks {seen.said(seen.lacking)} rms in the fleet: compare other families "
            "on it.",
        )
    if white or seen.rms <= smallest:
        return ()
    return ("What is left is not white: the shape may be another one, or its rate may matter.",)


def _unsure(seen: Seen) -> tuple[str, ...]:
    unsure = math.sqrt(max(seen.predicted**2 - seen.lacking**2, 0.0))
    if unsure <= UNSURE * seen.y_range:
        return ()
    return (
        f"Of its constants alone an error of {seen.said(unsure)} rms is to be expected: the record "
        "is short for what it must tell.",
    )

"""The output moves steadily in time, whatever the drive does."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import cycles_of
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

FEWEST_CYCLES = 2.0
"""Of the drive: in less, time and the two branches of a loop are not told apart."""


def _columns(remainder: Remainder) -> Array:
    """Give the time of every sample, in the duration of the longest record."""
    longest = _longest(remainder)
    if sum(cycles_of(each) for each in remainder.parts) < FEWEST_CYCLES:
        return np.empty((remainder.rows.size, 0))

    def of_part(part: Part) -> Array:
        return np.asarray((part.time - part.time.mean())[part.rows] / longest)[:, None]

    return remainder.columns(of_part)


def _longest(remainder: Remainder) -> float:
    return max(float(np.ptp(each.time)) for each in remainder.parts) or 1.0


def _sentence(found: Contribution) -> str:
    remainder, over = found.remainder, float(found.coefficients[0])
    rate = over / _longest(remainder)
    return (
        f"The output drifts by {remainder.plain(rate)}/s, in all by {remainder.said(abs(over))} "
        "over the record."
    )


DRIFT = Cause(
    "drift",
    _columns,
    _sentence,
    "The drift is none of the model: take it out of the record, or let the actuator warm up and "
    "record again, before small errors are judged.",
    disturbs=True,
)

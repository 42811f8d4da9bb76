"""The output moves slowly to and fro, more slowly than the drive."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import cycles_of
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

MOST_PIECES = 12
CYCLES_IN_A_PIECE = 2.0
"""A piece must be longer than a loop, or it would draw the loop."""

MOST_RECORDS = 4


def _columns(remainder: Remainder) -> Array:
    if len(remainder.parts) > MOST_RECORDS:
        return np.empty((remainder.rows.size, 0))
    pieces = [
        int(min(cycles_of(each) // CYCLES_IN_A_PIECE, MOST_PIECES)) for each in remainder.parts
    ]
    pieces = [each if each >= 3 else 0 for each in pieces]
    width = sum(pieces)

    def of_part(part: Part) -> Array:
        at = remainder.parts.index(part)
        columns = np.zeros((part.rows.size, width))
        if pieces[at]:
            first = sum(pieces[:at])
            columns[:, first : first + pieces[at]] = _hats(part, pieces[at])
        return columns

    return remainder.columns(of_part)


def _hats(part: Part, count: int) -> Array:
    """Give piecewise linear functions that are 1 at one knot each and 0 at the others."""
    at = np.linspace(0.0, count - 1.0, part.u.size)[part.rows]
    return np.maximum(1.0 - np.abs(at[:, None] - np.arange(count)), 0.0)


def _sentence(found: Contribution) -> str:
    return (
        "The output wanders slowly, whatever the drive does, which makes "
        f"{found.size} rms of what is left."
    )


WANDER = Cause(
    "wander",
    _columns,
    _sentence,
    "Slow wandering is temperature or creep and none of the model: leave it to a controller.",
    beyond_loops=True,
    disturbs=True,
    counts=0.85,
)

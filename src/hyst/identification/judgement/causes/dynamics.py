"""The output depends on what the input was some samples before, as with filters and resonances."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import octaves_of
from hyst.identification.judgement.remainder import Part, Remainder
from hyst.identification.judgement.slow_filter import low_passed

Array = NDArray[np.float64]

LAGS = (1, 2, 3, 5, 8)
TIME_CONSTANTS = (3.0, 10.0, 30.0)
"""Of low passes over the input, samples."""


FEWEST_OCTAVES = 0.5
"""Between frequencies of branches: with less, dynamics and shape of the loop are not told apart."""


def _columns(remainder: Remainder) -> Array:
    if octaves_of(remainder.parts) < FEWEST_OCTAVES:
        return np.empty((remainder.rows.size, 0))

    def of_part(part: Part) -> Array:
        u = part.whole
        at = part.places[part.rows]
        lagged = [u[np.maximum(at - each, 0)] - u[at] for each in LAGS]
        slow = [low_passed(u, each)[at] - u[at] for each in TIME_CONSTANTS]
        return np.column_stack([*lagged, *slow])

    return remainder.columns(of_part)


def _sentence(found: Contribution) -> str:
    return (
        "The output answers with dynamics (a filter, an amplifier's bandwidth, a resonance), which "
        f"makes {found.size} rms of what is left."
    )


DYNAMICS = Cause(
    "dynamics",
    _columns,
    _sentence,
    "Drive it more slowly, or use a model with dynamics (--family hammerstein).",
    beyond_loops=True,
)

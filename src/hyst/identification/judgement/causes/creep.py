"""The output goes on moving after the input has come to where it is, ever more slowly."""

from __future__ import annotations

import numpy as np
import scipy.ndimage
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import cycles_of
from hyst.identification.judgement.remainder import Part, Remainder
from hyst.identification.judgement.slow_filter import low_passed

Array = NDArray[np.float64]

OF_THE_RECORD = (1.0 / 3.0, 1.0 / 10.0, 1.0 / 30.0)
"""Time constants of the settling since the start, in durations of the record."""

OF_A_CYCLE = (1.0, 4.0)
"""Time constants by which the output follows the mean of the input, in cycles of the drive."""


def _columns(remainder: Remainder) -> Array:
    def of_part(part: Part) -> Array:
        # Places count from the first sample of the record: creep began with the drive.
        duration = float(part.places[-1] + 1)
        cycle = duration / max(cycles_of(part), 1.0)
        places = part.places[part.rows]
        settling = [np.exp(-places / (share * duration)) for share in OF_THE_RECORD]
        # Over a whole cycle, so that what follows it is no loop.
        mean = scipy.ndimage.uniform_filter1d(part.whole, max(round(cycle), 1), mode="nearest")
        following = [low_passed(mean, share * cycle)[places] for share in OF_A_CYCLE]
        logarithm = np.log1p(places / max(0.1 * cycle, 1.0))
        return np.column_stack([*settling, *following, logarithm])

    return remainder.columns(of_part)


def _sentence(found: Contribution) -> str:
    return (
        "The output creeps: it goes on moving, ever more slowly, after the drive has begun or its "
        f"mean has changed, which makes {found.size} rms of what is left."
    )


CREEP = Cause(
    "creep",
    _columns,
    _sentence,
    "Creep is none of the model: expect that much more error after a long rest or a change of the "
    "mean. Creep that follows the drive is identified with creep (--creep 2) from records that "
    "hold the input at several levels; else leave it to a controller.",
    beyond_loops=True,
    disturbs=True,
    counts=0.9,
)

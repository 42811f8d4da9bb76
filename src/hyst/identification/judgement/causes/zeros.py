"""The zero of the output is another one in another record."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

MOST_RECORDS = 40


def _columns(remainder: Remainder) -> Array:
    count = len(remainder.parts)
    if not 1 < count <= MOST_RECORDS:
        return np.empty((remainder.rows.size, 0))

    def of_part(part: Part) -> Array:
        columns = np.zeros((part.rows.size, count))
        columns[:, remainder.parts.index(part)] = 1.0
        return columns

    return remainder.columns(of_part)


def _sentence(found: Contribution) -> str:
    return f"The records have different zeros, which makes {found.size} rms of what is left."


ZEROS = Cause(
    "zeros",
    _columns,
    _sentence,
    "Bring the records to one zero, or record them without a pause.",
    disturbs=True,
)

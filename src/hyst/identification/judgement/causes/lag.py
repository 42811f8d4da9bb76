"""The output answers a part of a sample late, or early."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import octaves_of, swings_alike
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

FEWEST_OCTAVES = 0.5
"""Between frequencies of branches: one loop run at one rate does not tell lag and radius apart."""


def _columns(remainder: Remainder) -> Array:
    """Give the change of the model's output from sample to sample."""
    one_loop = octaves_of(remainder.parts) < FEWEST_OCTAVES and swings_alike(remainder.parts)
    if one_loop:
        return np.empty((remainder.rows.size, 0))

    def of_part(part: Part) -> Array:
        if part.modelled.size < 3:
            return np.zeros((part.rows.size, 1))
        return -np.gradient(part.modelled)[part.rows, None]

    return remainder.columns(of_part)


def _sentence(found: Contribution) -> str:
    samples = float(found.coefficients[0])
    dt = found.remainder.parts[0].dt
    late = "lags behind" if samples > 0.0 else "is ahead of"
    return (
        f"The output {late} the model by another {abs(samples):.2g} samples "
        f"({abs(samples) * dt:.2g} s), which makes {found.size} rms of what is left."
    )


LAG = Cause(
    "lag",
    _columns,
    _sentence,
    "If an amplifier or a filter lags, make that part of the model (lag='auto', or --lag auto); "
    "else align the channels (triggers, converters that are read one after the other) and record "
    "again, or record with more samples.",
    beyond_loops=True,
)

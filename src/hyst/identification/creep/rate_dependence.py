"""Loops that widen with the rate, which lags of a fraction of a stroke resemble."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.general_loops import RADII, play_outputs
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

EITHER_WAY = 0.1
"""Of a radius: half of what plays are compared over for their change with it."""


def widening_loops(remainder: Remainder) -> Array:
    """Give by what plays change whose radii grow with the rate, and the rate, shape (rows, 11).

    Parameters
    ----------
    remainder
        What a fit leaves.
    """
    rates = [_rate(each) for each in remainder.parts]
    fastest = max(float(np.abs(each).max(initial=0.0)) for each in rates) or 1.0
    radii = 0.5 * remainder.input_range * np.array(RADII)

    def of_part(part: Part) -> Array:
        places = part.places[part.rows]
        rate = _rate(part)[places] / fastest
        wider, narrower = (
            play_outputs(part.whole, radii * (1.0 + each), places)
            for each in (EITHER_WAY, -EITHER_WAY)
        )
        root = np.sign(rate) * np.sqrt(np.abs(rate))
        return np.column_stack([np.abs(rate)[:, None] * (wider - narrower), rate, root])

    return remainder.columns(of_part)


def _rate(part: Part) -> Array:
    if part.whole.size < 2:
        return np.zeros(part.whole.size)
    return np.asarray(np.gradient(part.whole) / part.dt)

"""The units of powers of two in which records are fitted."""

from __future__ import annotations

import math

import numpy as np

from hyst.identification.record_use.used_samples import Data


def scales_of(given: Data) -> tuple[float, float]:
    """Give the powers of two of input and output, in whose units their ranges are 1 to 2.

    Parameters
    ----------
    given
        The records in the user's units.
    """
    return (
        _power_of_two(2.0 * given.half_range),
        _power_of_two(max(float(np.ptp(each.y)) for each in given.records)),
    )


def _power_of_two(span: float) -> float:
    """Give the power of two whose ratio to a range lies between 1 and 2."""
    return math.ldexp(1.0, math.frexp(span)[1] - 1)

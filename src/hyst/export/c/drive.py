"""The input of the self-test: the same numbers in Python and in C, in either precision.

Straight runs between turning points at random, in whole multiples of a power of two; now and then a
sample that is not finite. ``templates/selftest.c.in`` forms the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SAMPLES = 10_000
PERIOD = 1000
_HALF_COUNT = 2**15
_STRIDES = 8  # a run takes at least so many samples from end to end


@final
@dataclass(frozen=True)
class Drive:
    """A range of whole numbers times a power of two.

    Parameters
    ----------
    low, count
        The lowest number, and how many there are.
    unit
        The power of two.
    """

    low: int
    count: int
    unit: float

    @classmethod
    def between(cls, low: float, high: float) -> Drive:
        """Give the drive of a range, ``low`` < ``high``."""
        _, exponent = math.frexp(max(high - low, 1e-6 * max(abs(low), abs(high))))
        unit = math.ldexp(1.0, exponent - 16)
        first, last = math.ceil(low / unit), math.floor(high / unit)
        return cls(first, last - first + 1, unit)

    @property
    def stride(self) -> int:
        """The largest step between two samples, in units."""
        return self.count // _STRIDES

    @property
    def high(self) -> float:
        """The upper end of the range."""
        return (self.low + self.count - 1) * self.unit

    def samples(self, seed: int, bad: int, count: int = SAMPLES) -> Array:
        """Give the input.

        Parameters
        ----------
        seed
            Of the turning points.
        bad
            Which sample of every period is NaN; the one after it is infinite.
        count
            How many.
        """
        place = goal = self.low
        stride = 1
        result = np.empty(count)
        for k in range(count):
            if place == goal:
                seed = (seed * 1664525 + 1013904223) % 2**32
                goal = self.low + (seed >> 8) % self.count
                seed = (seed * 1664525 + 1013904223) % 2**32
                stride = 1 + (seed >> 8) % self.stride
            else:
                step = min(stride, abs(goal - place))
                place += step if goal > place else -step
            result[k] = place * self.unit
        result[bad % PERIOD :: PERIOD] = np.nan
        result[bad % PERIOD + 1 :: PERIOD] = np.inf
        return result

"""An axis: from values to pixels, with ticks at round numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_ROOM = 0.04


@dataclass(frozen=True)
class Axis:
    """Where values lie.

    Parameters
    ----------
    low, high
        Values at its ends, or their logarithms.
    begin, end
        Pixels of its ends.
    logarithmic
        Whether it counts powers of ten.
    """

    low: float
    high: float
    begin: float
    end: float
    logarithmic: bool = False

    @staticmethod
    def over(
        values: NDArray[np.float64], begin: float, end: float, logarithmic: bool = False
    ) -> Axis:
        """Give an axis that holds all finite values, with a little room.

        Parameters
        ----------
        values
            To hold.
        begin, end, logarithmic
            As of the axis.
        """
        finite = values[np.isfinite(values)]
        if logarithmic:
            finite = np.log10(finite[finite > 0.0])
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
        room = _ROOM * (high - low) or max(abs(low), 1.0) * _ROOM
        return Axis(low - room, high + room, begin, end, logarithmic)

    def pixels(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Give the pixels of values, those beyond an end at most a width beyond it.

        Parameters
        ----------
        values
            Anywhere.
        """
        if self.logarithmic:
            values = np.log10(np.maximum(values, 10.0**self.low))
        share = np.clip((values - self.low) / (self.high - self.low), -1.0, 2.0)
        return self.begin + (self.end - self.begin) * share

    def ticks(self, about: int = 5) -> list[tuple[float, str]]:
        """Give pixels and labels of round numbers.

        Parameters
        ----------
        about
            How many.
        """
        if self.logarithmic:
            return self._decades(about)
        step = (self.high - self.low) / about
        power = 10.0 ** math.floor(math.log10(step))
        step = power * min(_STEPS, key=lambda each: abs(math.log(each * power / step)))
        first = math.ceil(self.low / step)
        numbers = [k * step for k in range(first, math.floor(self.high / step) + 1)]
        return [(float(self.pixels(np.array([each]))[0]), _label(each, step)) for each in numbers]

    def _decades(self, about: int) -> list[tuple[float, str]]:
        every = max(1, math.ceil((self.high - self.low) / about))
        powers = range(math.ceil(self.low), math.floor(self.high) + 1, every)
        return [(float(self.pixels(np.array([10.0**k]))[0]), f"{10.0**k:g}") for k in powers]


def _label(value: float, step: float) -> str:
    # Multiples of a round step, so that six digits are all of them.
    return "0" if abs(value) < 1e-9 * step else f"{value:.6g}"

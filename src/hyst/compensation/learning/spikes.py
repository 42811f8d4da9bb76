"""Spikes of a sensor: a sample or two that no motion makes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_HALF = 2
"""Samples to either side for a median: it passes steps and drops what is two samples wide."""

_USUAL, _IN_SIZES = 0.98, 2.33
"""Share of the samples that are no spikes, and its quantile of a normal distribution."""

_CLEAR, _OF_RANGE, _STEPS = 10.0, 0.02, 3.0
"""Times the usual size, of the range of the motion, and times its fastest change in a sample: what
a spike is above, of all of these."""


@dataclass(frozen=True, eq=False)
class Despiked:
    """An output, and what was taken out of it.

    Parameters
    ----------
    y
        Shape (N,).
    count
        Samples that were replaced.
    largest
        By how much at most.
    """

    y: Array
    count: int
    largest: float

    @property
    def notes(self) -> list[str]:
        """What to tell of it."""
        if not self.count:
            return []
        return [
            f"{self.count} sample{'s' if self.count > 1 else ''} of the measured output jump by up "
            f"to {self.largest:.4g} and back; the median of those around is taken instead"
        ]


def without_spikes(y: Array, expected: Array) -> Despiked:
    """Replace spikes of an output by the median of the samples around.

    Parameters
    ----------
    y
        Measured, shape (N,).
    expected
        What it is about to be, shape (N,): what jumps and back there is no spike.
    """
    middle, off = _median(y)
    _, own = _median(expected)
    least = max(
        _CLEAR * float(np.quantile(np.abs(off), _USUAL)) / _IN_SIZES,
        _OF_RANGE * float(np.ptp(expected)),
        _STEPS * float(np.quantile(np.abs(np.diff(y)), _USUAL)),
        _STEPS * float(np.abs(np.diff(expected)).max()),
        _STEPS * float(np.abs(own).max()),
    )
    spikes = np.abs(off) > least
    if not spikes.any():
        return Despiked(y, 0, 0.0)
    return Despiked(
        np.where(spikes, middle, y), int(spikes.sum()), float(np.abs(off[spikes]).max())
    )


def _median(signal: Array) -> tuple[Array, Array]:
    """Give the running median, and what is off it."""
    wide = np.pad(signal, _HALF, mode="reflect")
    middle = np.median(np.lib.stride_tricks.sliding_window_view(wide, 2 * _HALF + 1), axis=1)
    return middle, signal - middle

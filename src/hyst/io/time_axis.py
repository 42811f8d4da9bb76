"""From time stamps to an even time step, or a clear refusal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError

# Largest deviation of a gap between samples from the median gap, relative to the median.
TOLERANCE = 0.01
# A record resampled to more than this many times its length would be mostly invention.
_MOST_GROWTH = 10


@dataclass(frozen=True)
class Gap:
    """The gap between two time stamps that is furthest from the median gap.

    Parameters
    ----------
    row
        Index of the earlier of the two.
    size, median
        This gap and the median gap, in the unit of the stamps.
    """

    row: int
    size: float
    median: float

    @property
    def even(self) -> bool:
        """Whether it is within the tolerance, so that all are."""
        return abs(self.size - self.median) <= TOLERANCE * self.median


def worst_gap(time: NDArray[np.float64]) -> Gap:
    """Find the gap furthest from the median gap.

    Parameters
    ----------
    time
        Time stamps, shape (N,), N >= 2, increasing.

    Returns
    -------
    Gap
        The first one of those that deviate most.

    Examples
    --------
    >>> worst_gap(np.array([0.0, 1.0, 2.0, 5.0, 6.0]))
    Gap(row=2, size=3.0, median=1.0)
    """
    # Stamps too far apart for a double give an infinite gap, which is uneven and thus refused.
    with np.errstate(over="ignore", invalid="ignore"):
        gaps = np.diff(time)
        median = float(np.median(gaps))
        row = int(np.argmax(np.abs(gaps - median)))
    return Gap(row, float(gaps[row]), median)


def first_step_back(time: NDArray[np.float64]) -> int | None:
    """Find the first index whose time is not after the one before, if there is one.

    Examples
    --------
    >>> first_step_back(np.array([0.0, 1.0, 1.0, 2.0]))
    2
    """
    back = np.flatnonzero(~(time[1:] > time[:-1]))
    return int(back[0]) + 1 if back.size else None


def resample(
    time: NDArray[np.float64], signals: list[NDArray[np.float64]], dt: float
) -> list[NDArray[np.float64]]:
    """Interpolate signals linearly onto even steps from the first time stamp on.

    Parameters
    ----------
    time
        Time stamps, shape (N,), increasing.
    signals
        Vectors, shape (N,).
    dt
        Wanted step, in the unit of the stamps.

    Returns
    -------
    list of numpy.ndarray
        The signals at time[0], time[0] + dt, ... up to the last time stamp.

    Raises
    ------
    InputError
        If the result would have more than 10 times as many samples.

    Examples
    --------
    >>> resample(np.array([0.0, 1.0, 3.0]), [np.array([0.0, 2.0, 6.0])], 1.0)
    [array([0., 2., 4., 6.])]
    """
    # The last stamp is kept when rounding has put it just before its place on the grid.
    steps = float(time[-1] - time[0]) / dt * (1.0 + 1e-12) + 1e-6
    if not steps < _MOST_GROWTH * time.size:
        raise InputError(
            f"resampling {time.size} samples onto their median gap would make {steps:.3g} of "
            "them; cut the record at its long gaps first"
        )
    # Samples that stand on the grid, but for rounding, keep their values to the last bit.
    places = (time - time[0]) / dt
    on_grid = np.rint(places)
    if float(np.abs(places - on_grid).max()) <= TOLERANCE:
        places = on_grid
    grid = np.arange(int(steps) + 1)
    return [np.interp(grid, places, signal) for signal in signals]

"""Time stamps of a clock that is slower than the samples, so that each stands several times."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_FEWEST_SAMPLES, _FEWEST_STAMPS = 8, 4
_FEWEST_REPEATED = 1.2
# Stamps may lag by the clock's step, and the loop that writes them jitters too.
_SLACK = 1.05


@dataclass(frozen=True)
class CoarseStamps:
    """What stamps that repeat say.

    Parameters
    ----------
    step
        Mean time between samples, in the unit of the stamps.
    clock
        Usual time between different stamps.
    fewest, most
        How often a stamp stands at least and at most, the first and last aside.
    """

    step: float
    clock: float
    fewest: int
    most: int


def coarse_stamps(time: NDArray[np.float64]) -> CoarseStamps | None:
    """Find the mean step of stamps that repeat because their clock is slower than the samples.

    Parameters
    ----------
    time
        Time stamps, shape (N,).

    Returns
    -------
    CoarseStamps or None
        None unless stamps never fall, repeat all along, and stay within one step of their clock
        of an even raster.

    Examples
    --------
    >>> coarse_stamps(np.repeat([0.0, 0.01, 0.02, 0.03, 0.04], 2))
    CoarseStamps(step=0.005, clock=0.01, fewest=2, most=2)
    """
    if time.size < _FEWEST_SAMPLES or not (time[1:] >= time[:-1]).all():
        return None
    starts = np.concatenate(([0], np.flatnonzero(time[1:] > time[:-1]) + 1))
    if starts.size < _FEWEST_STAMPS or time.size < _FEWEST_REPEATED * starts.size:
        return None
    # The first stamp may have been there before the record began.
    first, last = (starts[1], starts[-1])
    step = float(time[last] - time[first]) / float(last - first)
    clock = float(np.median(np.diff(time[starts])))
    even = time[first] + step * (np.arange(time.size) - first)
    if float(np.abs(time - even).max()) > _SLACK * max(clock, step):
        return None
    sizes = np.diff(starts)[1:]
    return CoarseStamps(step, clock, int(sizes.min()), int(sizes.max()))

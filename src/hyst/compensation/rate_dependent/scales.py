"""Sizes by which the smoothing of a trajectory inversion is chosen for the user."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.compensation.rate_dependent.trajectory_descent import Stage

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scales:
    """Gain of the plays, and how far and how fast the drive moves.

    Parameters
    ----------
    gain
        Sum of all weights, output units per input unit.
    change
        Largest change of the drive per sample, input units.
    extent
        Range of the drive, input units.
    """

    gain: float
    change: float
    extent: float

    def stage(self, roughness: float, rate: float, contact: float) -> Stage:
        """Give a stage from numbers without units.

        Parameters
        ----------
        roughness
            Over the squared gain.
        rate
            Over the largest change per sample.
        contact
            Over the range of the drive.

        Returns
        -------
        Stage
        """
        return Stage(roughness * self.gain**2, rate * self.change, contact * self.extent)

    @property
    def penalty(self) -> float:
        """Weight of a violated limit: a hundred times that of the same error of the output."""
        return 100.0 * self.gain**2


def scales_of(task: RateDependentTask, drive: Array) -> Scales | None:
    """Measure a first drive.

    Parameters
    ----------
    task
        Plays and target.
    drive
        Shape (N,), a first guess.

    Returns
    -------
    Scales or None
        None if the drive does not move, so that there is nothing to solve.
    """
    change = float(np.abs(np.diff(drive)).max(initial=0.0))
    if change == 0.0:
        return None
    gain = task.plays.p0 + float(np.abs(task.plays.p).sum())
    return Scales(gain, change, float(np.ptp(drive)))

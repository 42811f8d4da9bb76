"""Levenberg-Marquardt on the simulated tracking error of rate-dependent plays, corners rounded.

A step costs one Riccati recursion over the record in the engine: time and memory grow like the
number of samples, whatever the plays do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine

Array = NDArray[np.float64]

_SMALL_DECREASE = 1e-3
_SMALL_IN_A_ROW = 3
_HOPELESS = 1e-9
_LARGEST_DAMPING = 1e8


@dataclass(frozen=True)
class Stage:
    """How much the problem is smoothed.

    Parameters
    ----------
    roughness
        Weight of the squared second differences of the drive, output units squared per input unit
        squared.
    rate, contact
        Over what change per sample and what distance from contact corners are rounded, input units.
    """

    roughness: float
    rate: float
    contact: float


@dataclass(frozen=True, eq=False)
class Descent:
    """A tracking problem over a stretch of the reference.

    Parameters
    ----------
    chain
        One bank of rate-dependent plays.
    state
        Its state before the stretch.
    target
        Wanted output, shape (N,).
    low, high, change
        Range of the drive and of its change per sample; infinite if there is none.
    penalty
        Weight of their squared violation.
    """

    chain: _engine.Chain
    state: Array
    target: Array
    low: float = -np.inf
    high: float = np.inf
    change: float = np.inf
    penalty: float = 0.0

    def descend(
        self, drive: Array, stage: Stage, iterations: int
    ) -> tuple[Array, float, int, bool]:
        """Improve a drive.

        Parameters
        ----------
        drive
            Shape (N,), where to start.
        stage
            How much to smooth.
        iterations
            Steps tried at most.

        Returns
        -------
        drive : numpy.ndarray
        cost : float
            At the drive, smoothed.
        tried : int
            Steps.
        converged : bool
            Whether nothing was left to gain.
        """
        limits = _engine.Limits(self.low, self.high, self.change, self.penalty)
        rounding = _engine.Rounding(stage.rate, stage.contact)
        task = (self.chain, self.state, self.target)
        terms = (stage.roughness, rounding, limits)
        cost = _engine.trajectory_cost(*task, drive, *terms)
        step = np.empty_like(drive)
        damping, small = 1e-3, 0
        for tried in range(1, iterations + 1):
            promise = _engine.trajectory_step(*task, drive, *terms, damping, step)
            if promise <= _HOPELESS * cost * (1.0 if damping < 1.0 else 1.0 / damping):
                return drive, cost, tried, True
            trial = drive + step
            gained = cost - _engine.trajectory_cost(*task, trial, *terms)
            if gained > 1e-4 * promise:
                small = small + 1 if gained < _SMALL_DECREASE * cost else 0
                drive, cost = trial, cost - gained
                damping *= max(0.2, 1.0 - (2.0 * gained / promise - 1.0) ** 3)
                if small == _SMALL_IN_A_ROW:
                    return drive, cost, tried, True
            else:
                damping = max(4.0 * damping, 1e-6)
                if damping > _LARGEST_DAMPING:
                    return drive, cost, tried, True
        return drive, cost, iterations, False


def within_limits(
    drive: Array, before: float | None, low: float, high: float, change: float
) -> Array:
    """Hold a drive within its range and its change per sample, sample after sample.

    Parameters
    ----------
    drive
        Shape (N,).
    before
        The drive before the first sample, or None.
    low, high, change
        The limits; infinite ones do nothing.

    Returns
    -------
    numpy.ndarray
    """
    held = np.clip(drive, low, high)
    if not np.isfinite(change):
        return held
    last = before
    for k, wanted in enumerate(held.tolist()):
        if last is not None:
            wanted = min(max(wanted, last - change), last + change)
        held[k] = last = wanted
    return held

"""Counters that start again at their other end in the midst of a signal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Samples = NDArray[np.intp]

_FEWEST_JUMPS = 2
_LEAST_MOTION = 0.3
_LARGEST_STEP = 0.25
_MOST_SHARE = 0.1
_SIDE = 4
_MOSTLY = 0.75


@dataclass(frozen=True, eq=False)
class Wraps:
    """Where a signal wraps, and by how much.

    Parameters
    ----------
    samples
        Shape (m,), first samples behind each jump.
    span
        By which the signal jumps, in its units.
    """

    samples: Samples
    span: float


def wraps_in(signal: Array, other: Array) -> Wraps | None:
    """Find jumps of one span that go against the way of the signal.

    Put together again the signal must go on without a jump, move by much, and belong better to the
    other signal of the record than before; so a sawtooth drive that the output follows, a switch
    and a step are no wraps.

    Parameters
    ----------
    signal, other
        The signal in question and the other one of the record, shape (N,), finite.

    Returns
    -------
    Wraps or None
    """
    spread = float(np.ptp(signal))
    if signal.size < 8 or spread == 0.0:
        return None
    steps = np.diff(signal / spread)
    jumps = np.flatnonzero(np.abs(steps) > 0.5)
    if not _FEWEST_JUMPS <= jumps.size <= _MOST_SHARE * signal.size:
        return None
    size = np.abs(steps[jumps])
    span = float(np.median(size))
    if np.any(np.abs(size - span) > _LARGEST_STEP * span) or span < 0.75:
        return None
    # A jump is the span less the step that goes on meanwhile.
    before = np.abs(steps[np.maximum(jumps - 1, 0)])
    behind = np.abs(steps[np.minimum(jumps + 1, steps.size - 1)])
    span = float(np.median(size + np.minimum(before, behind)))
    corrections = np.zeros(steps.size)
    corrections[jumps] = -np.sign(steps[jumps]) * span
    whole = np.concatenate(([0.0], np.cumsum(steps + corrections)))
    if not _goes_on(whole, steps, jumps, span):
        return None
    if _relation(whole, other) <= max(_relation(signal, other), 0.5):
        return None
    return Wraps(jumps + 1, span * spread)


def _goes_on(whole: Array, steps: Array, jumps: Samples, span: float) -> bool:
    """Whether the signal put together goes on as smoothly as elsewhere, and jumps against it."""
    moves = np.abs(np.diff(whole))
    elsewhere = np.delete(moves, jumps)
    smooth = np.all(moves[jumps] <= 3.0 * float(elsewhere.max()) + 0.02 * span)
    last = whole.size - 1
    way = whole[np.minimum(jumps + 1 + _SIDE, last)] - whole[np.maximum(jumps - _SIDE, 0)]
    return bool(
        smooth
        and float(elsewhere.max()) < _LARGEST_STEP * span
        and float(np.mean(steps[jumps] * way < 0.0)) >= _MOSTLY
        and float(np.ptp(whole)) >= _LEAST_MOTION * span
    )


def _relation(signal: Array, other: Array) -> float:
    """Square of the correlation of two signals, 0 where one of them is constant."""
    if np.ptp(signal) == 0.0 or np.ptp(other) == 0.0:
        return 0.0
    return float(np.corrcoef(signal / np.ptp(signal), other / np.ptp(other))[0, 1] ** 2)

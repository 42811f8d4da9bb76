"""Steps of a converter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_FEWEST_SAMPLES = 50
_FEWEST_LEVELS = 3
_MOST_DIFFERENT = 0.7
# Rounded decimals are whole steps up to this share of a step.
_SAME = 0.02
_WHOLE_STEPS = 0.98
_ROUNDING = 1e-13
_LEAST_CHANGES = 0.05


@dataclass(frozen=True)
class Levels:
    """Evenly spaced values of a signal.

    Parameters
    ----------
    step
        Between two neighbouring values a converter gives, in units of the signal.
    used
        How many different values the signal takes.
    """

    step: float
    used: int


def levels_of(signal: NDArray[np.float64]) -> Levels | None:
    """Find the step of the converter a signal came through.

    All its values are whole steps apart, many are taken again, and it goes by
    ever different numbers of steps: a triangle that repeats has few values too.

    Parameters
    ----------
    signal
        Shape (N,), finite.

    Returns
    -------
    Levels or None
        None where no step can be told.
    """
    if signal.size < _FEWEST_SAMPLES:
        return None
    values = np.unique(signal / 4.0)
    if not _FEWEST_LEVELS <= values.size <= _MOST_DIFFERENT * signal.size:
        return None
    gaps = np.diff(values)
    step = float(gaps.min())
    # The smallest gap itself carries the rounding of decimals; the mean of all does not.
    if step < _ROUNDING * float(np.max(np.abs(values))):
        return None
    single = gaps[gaps < 1.5 * step]
    step = float(single.mean())
    if not _mostly_whole(gaps / step):
        return None
    moves = np.round(np.abs(np.diff(signal / 4.0)) / step)
    if float(np.mean(moves[1:] != moves[:-1])) < _LEAST_CHANGES:
        return None
    return Levels(4.0 * step, int(values.size))


def _mostly_whole(numbers: NDArray[np.float64]) -> bool:
    """Whether numbers are whole, up to a few."""
    off = np.abs(numbers - np.round(numbers))
    return float(np.mean(off < _SAME)) >= _WHOLE_STEPS

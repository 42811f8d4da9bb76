"""Time stamps that stand on even steps but were rounded, or written by a clock that jitters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# From fewer stamps the mean step is hardly better known than a single one.
_FEWEST = 20
# Instants are wrong by no more than this share of a step: what a record loses by it is little.
_JITTER = 0.1
# Coarser rounding cannot be told from lost samples.
_COARSEST = 0.5
_SLACK = 1.25
_MOST_DIGITS = 12


@dataclass(frozen=True)
class EvenSteps:
    """Even steps that stamps stand on.

    Parameters
    ----------
    step
        Mean step, in the unit of the stamps.
    deviation
        How far stamps are from even steps at most.
    resolution
        What stamps are rounded to; 0 where they only jitter.
    """

    step: float
    deviation: float
    resolution: float


def even_steps(time: NDArray[np.float64]) -> EvenSteps | None:
    """Find the even steps that rounded or jittering stamps stand on.

    Parameters
    ----------
    time
        Time stamps, shape (N,), increasing.

    Returns
    -------
    EvenSteps or None
        The line of least squares through the stamps, if all of them, and all gaps, are within
        their resolution of it (at most half a step), or within a tenth of a step.

    Examples
    --------
    >>> found = even_steps(np.round(np.arange(100) * 0.025, 2))
    >>> round(found.step, 4), round(found.resolution, 4)
    (0.025, 0.01)
    """
    if time.size < _FEWEST or np.abs(time).max() > 1e30:
        return None
    count = np.arange(time.size) - 0.5 * (time.size - 1)
    centred = time - time.mean()
    step = float(count @ centred / (count @ count))
    if not (np.isfinite(step) and step > 0.0):
        return None
    spread = float(np.ptp(centred - step * count))
    worst = float(np.abs(np.diff(time) - step).max())
    if spread <= _JITTER * step and worst <= _JITTER * step:
        return EvenSteps(step, 0.5 * spread, 0.0)
    resolution = _resolution(time, _COARSEST * step)
    if resolution is None or max(spread, worst) > _SLACK * resolution:
        return None
    return EvenSteps(step, 0.5 * spread, resolution)


def _resolution(time: NDArray[np.float64], largest: float) -> float | None:
    """Find what stamps were rounded to: a decimal, a count, or the spacing of single precision."""
    single = float(np.spacing(np.float32(np.abs(time).max())))
    if single <= largest and _is_single(time, single):
        return single
    for digits in range(_MOST_DIGITS):
        scaled = (time - time[0]) * 10.0**digits
        doubt = np.abs(time).max() * 10.0**digits * 2.0**-50
        if doubt > _JITTER or np.abs(scaled).max() > 2.0**52:
            return None
        if np.abs(scaled - np.rint(scaled)).max() <= max(1e-6, 2.0 * doubt):
            gaps = np.diff(np.rint(scaled).astype(np.int64))
            unit = float(np.gcd.reduce(gaps)) / 10.0**digits
            return unit if unit <= largest else None
    return None


def _is_single(time: NDArray[np.float64], spacing: float) -> bool:
    """Tell whether stamps are numbers of single precision, printed with some more digits."""
    off = np.abs(time - time.astype(np.float32).astype(np.float64))
    return float(off.max()) <= 0.02 * spacing

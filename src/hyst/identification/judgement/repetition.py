"""The period of a drive that repeats, and what an error does that repeats with it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.drive_period import drive_period
from hyst.diagnosis.interpolation import earlier, first_comparable
from hyst.identification.judgement.regression import chance, correlation_time
from hyst.identification.judgement.remainder import Part

Array = NDArray[np.float64]

SAME_DRIVE = 2e-3
"""Of the input's range, rms: so near are two periods of a drive that repeats."""

FEWEST_AT_A_PHASE = 3
"""Samples, on the average: a period is divided as finely as these allow."""


def period_of(part: Part) -> float:
    """Give the samples, no whole number, after which all of the drive repeats; 0 if it does not."""
    return repeats_after(part.u)


def repeats_after(u: Array) -> float:
    """Give the samples, no whole number, after which all of a drive repeats; 0 if it does not.

    Parameters
    ----------
    u
        Shape (n,).
    """
    found = drive_period(u)
    if found is None:
        return 0.0
    apart = u[first_comparable(found) :] - earlier(u, found)[0]
    same = float(np.sqrt(np.mean(apart**2))) <= SAME_DRIVE * float(np.ptp(u))
    return found if same else 0.0


def repeating(error: Array, places: NDArray[np.intp], period: float, unlikely: float) -> float:
    """Give the sum of squares of what repeats with the drive, or 0 if noise may do it.

    Parameters
    ----------
    error
        Shape (n,).
    places
        Shape (n,), samples of the part they are.
    period
        Of the drive, samples.
    unlikely
        Probability below which noise does not do it.
    """
    phases = min(int(period), max(error.size // FEWEST_AT_A_PHASE, 1))
    phase = np.minimum((places % period) * phases / period, phases - 1).astype(np.intp)
    count = np.bincount(phase, minlength=phases)
    mean = np.bincount(phase, error, minlength=phases) / np.maximum(count, 1)
    rest = error - mean[phase]
    whole, scatter = float(error @ error), float(rest @ rest)
    directions = int(np.count_nonzero(count)) - 1
    time, left = correlation_time(rest), error.size - directions - 1
    # Phases near each other share their noise, as samples do: both count less by the same factor.
    independent = max(round(directions / time), 1)
    if chance(whole, scatter, independent, left / time) > unlikely:
        return 0.0
    by_noise = directions * scatter / max(left, 1)
    return max(whole - scatter - by_noise, 0.0)

"""Drives without the noise of their measurement.

Noise of a measured drive is no motion of the actuator, but one difference of it is a rate. A
smoother over the whole record, future included, takes it out without a lag: it minimises

    sum (s - u)^2 + strength sum (third differences of s)^2,

where, if that describes the drive better, differences across its turns do not count, so that the
corners of a triangle stay: two of them where a corner is at a sample, three where it is between
two. A model that is identified so holds no filter, and is to be given the
commanded drive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.signals import Record, reversals

Array = NDArray[np.float64]

ORDER = 3

DIFFERENCES = 4
"""Times a drive is differenced, which leaves its noise and little of a motion."""

ALTERNATING = 0.65
"""Share of neighbouring differences of opposite signs, from which they are noise: 0.8 of white
noise, and none of a motion."""

ROUNDING = 1e-7
"""Of the drive's range: smaller noise is that of printed digits."""

STRONGEST = 1e10
"""Beyond, rounding would show; it takes half of an oscillation of 290 samples."""

PER_OCTAVE = 2
"""Strengths that are compared for every octave of what is smoothed."""

FEWEST = 50
"""Samples, with less of which nothing is said of noise."""

NOISES_PER_TURN = 8.0
"""A turn stands out of so many standard deviations of the noise."""


@dataclass(frozen=True, eq=False)
class Smoother:
    """What was done to a drive.

    Parameters
    ----------
    strength
        Of the penalty.
    gaps
        Third differences that do not count, by their first sample; empty where all do.
    noise
        Standard deviation of what was taken out, for the freedom it had, input units.
    corner
        Frequency of which half is taken out, Hz.
    time_constant
        As it was asked for, s; None where cross-validation chose.
    """

    strength: float
    gaps: NDArray[np.intp]
    noise: float
    corner: float
    time_constant: float | None = None

    def __call__(self, u: Array) -> Array:
        """Smooth signals of the record's length.

        Parameters
        ----------
        u
            Shape (N,) or (N, k).
        """
        return smoothed(u, self.strength, self.gaps)


def without_noise(record: Record, time_constant: float | None = None) -> Smoother | None:
    """Give what takes the noise out of a drive; None where it shows none.

    Parameters
    ----------
    record
        The record.
    time_constant
        ``1 / (2 pi corner)``, s, of a penalty that goes through; None: strength and gaps of the
        least generalised cross-validation, where the drive is noisy.

    Raises
    ------
    InputError
        If the time constant is longer than rounding allows.

    Notes
    -----
    P. H. C. Eilers, A perfect smoother, Anal. Chem. 75 (2003), 3631-3636; P. Craven and G. Wahba,
    Smoothing noisy data with spline functions, Numer. Math. 31 (1979), 377-403.
    """
    u, none = record.u, np.empty(0, dtype=np.intp)
    if time_constant is not None:
        chosen = _strength(record.dt / time_constant)
        if chosen > STRONGEST:
            longest = record.dt * STRONGEST ** (0.5 / ORDER)
            raise InputError(
                f"rate_filter is {time_constant:.4g} s but samples are {record.dt:.4g} s apart; "
                f"give at most {longest:.4g} s, or thin the record"
            )
        # No sample tells of what is shorter than the time between two.
        if u.size < FEWEST or record.dt >= math.pi * time_constant:
            return None
        return replace(_smoother(record, chosen, none), time_constant=time_constant)
    if u.size < FEWEST or not is_noisy(u):
        return None
    through, score = _best_strength(u, none)
    best = score, through, none
    for gaps in _gaps_at_turns(u, smoothed(u, through, none)):
        strength, its_score = _best_strength(u, gaps)
        best = min(best, (its_score, strength, gaps), key=lambda each: each[0])
    return _smoother(record, *best[1:])


def _gaps_at_turns(u: Array, first: Array) -> tuple[NDArray[np.intp], ...]:
    """Give what does not count if corners are at samples, and if they are between two."""
    least = max(NOISES_PER_TURN * noise_size(u), 0.05 * float(np.ptp(u)))
    turns = reversals(first, least)  # a noisy drive turns where its first smoothing does
    turns = turns[(turns > ORDER) & (turns < u.size - ORDER - 1)]
    # The corner is between a turn and the neighbour that is closer to it.
    after = np.abs(first[turns + 1] - first[turns]) <= np.abs(first[turns - 1] - first[turns])
    at = np.concatenate([turns - 2, turns - 1])
    between = np.concatenate([turns - 2, turns - 1, np.where(after, turns, turns - 3)])
    return np.unique(at), np.unique(between)


def driven_by(record: Record, smoother: Smoother | None) -> Record:
    """Give a record with a smoothed drive; the same one without a smoother.

    Parameters
    ----------
    record, smoother
        The record, and what was made for it.
    """
    return record if smoother is None else replace(record, u=smoother(record.u))


def is_noisy(u: Array) -> bool:
    """Tell whether a drive holds noise that changes from sample to sample.

    Parameters
    ----------
    u
        Shape (N,).
    """
    if noise_size(u) <= ROUNDING * float(np.ptp(u)):
        return False
    changes = np.diff(u, n=DIFFERENCES)
    return float(np.mean(changes[1:] * changes[:-1] < 0.0)) > ALTERNATING


def noise_size(u: Array) -> float:
    """Give the standard deviation of the noise of a drive, if it is white.

    Parameters
    ----------
    u
        Shape (N,).
    """
    size = float(np.median(np.abs(np.diff(u, n=DIFFERENCES)))) / 0.6745
    return size / math.sqrt(math.comb(2 * DIFFERENCES, DIFFERENCES))


def smoothed(u: Array, strength: float, gaps: NDArray[np.intp]) -> Array:
    """Smooth signals.

    Parameters
    ----------
    u
        Shape (N,) or (N, k).
    strength, gaps
        As of ``Smoother``.
    """
    n = len(u)
    counts = np.full(n - ORDER, strength)
    counts[gaps] = 0.0
    coefficients = np.array([math.comb(ORDER, i) * (-1.0) ** i for i in range(ORDER + 1)])
    bands = np.zeros((ORDER + 1, n))
    bands[0] = 1.0
    for i in range(ORDER + 1):
        for j in range(i + 1):
            bands[i - j, j : j + n - ORDER] += coefficients[i] * coefficients[j] * counts
    return np.asarray(scipy.linalg.solveh_banded(bands, u, lower=True, check_finite=False))


def _strength(angle: float) -> float:
    """Give the strength that takes half of an oscillation of so many radians a sample."""
    return float((2.0 * math.sin(min(angle, math.pi) / 2.0)) ** (-2 * ORDER))


def _smoother(record: Record, strength: float, gaps: NDArray[np.intp]) -> Smoother:
    rest = record.u - smoothed(record.u, strength, gaps)
    freedom = max(record.u.size - _trace(record.u.size, strength, gaps), 1.0)
    angle = 2.0 * math.asin(min(0.5 * strength ** (-0.5 / ORDER), 1.0))
    noise = math.sqrt(float(rest @ rest) / freedom)
    return Smoother(strength, gaps, noise, angle / (2.0 * math.pi * record.dt))


def _trace(n: int, strength: float, gaps: NDArray[np.intp]) -> float:
    """Give about how many values are left free, from the oscillations between free ends."""
    first = gaps[np.diff(gaps, prepend=-ORDER - 1) > 1]
    edges = np.concatenate([[0], first + ORDER, [n]])
    joined = ORDER * first.size - gaps.size  # a corner at a sample is one value for both sides
    free = 0.0
    for length in np.diff(edges):
        angles = np.pi * np.maximum(np.arange(length) - 0.5 * (ORDER - 1), 0.0) / max(length, 1)
        free += float(np.sum(1.0 / (1.0 + strength * (2.0 * np.sin(angles / 2.0)) ** (2 * ORDER))))
    return free - joined


def _best_strength(u: Array, gaps: NDArray[np.intp]) -> tuple[float, float]:
    """Give the strength of the least generalised cross-validation, and that."""
    octaves = math.log2(math.pi) + math.log2(STRONGEST) / (2.0 * ORDER)
    angles = math.pi * 2.0 ** (-np.arange(1.0, PER_OCTAVE * octaves) / PER_OCTAVE)

    def score(strength: float) -> float:
        rest = u - smoothed(u, strength, gaps)
        return float(rest @ rest) / (u.size - _trace(u.size, strength, gaps)) ** 2

    scored = [(score(each), each) for each in map(_strength, angles.tolist())]
    least, strength = min(scored)
    return strength, least

"""What records show of sliding: at which velocities, and where a fit of its friction may start."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record, reversals

Array = NDArray[np.float64]

TRAVELS = np.geomspace(0.003, 3.0, 16)
"""Way to sliding of first guesses, over half the input range."""
SPEEDS = (0.03, 0.1, 0.3, 1.0)
"""Velocities of first guesses, over the mean square speed of the records."""
SMOOTHED = 0.05
"""Of the mean stroke: the time over which velocities are averaged, or a converter's steps count."""
SLIDING = 0.5
"""Way since a turn over the half range from which on friction surely slides."""


def velocities(data: Data) -> Array:
    """Give the velocity of every sample used, that of the first sample of a record 0.

    Parameters
    ----------
    data
        The records.

    Returns
    -------
    numpy.ndarray
        Shape (samples used,), input units per second.
    """
    pairs = zip(data.records, data.windows(), strict=True)
    return data.joined([np.diff(r.u, prepend=r.u[0])[w] / r.dt for r, w in pairs])


def spread_of_speeds(data: Data) -> float:
    """Give how far the speeds of sliding in one direction are apart, largest over smallest.

    Two velocities of opposite directions tell nothing: an offset takes their difference.

    Parameters
    ----------
    data
        The records.

    Returns
    -------
    float
        At least 1; of the nine tenths and the one tenth quantile.
    """
    speeds = np.concatenate([_sliding_velocities(r, data.half_range) for r in data.records])
    spreads = [1.0]
    for each in (speeds[speeds > 0.0], -speeds[speeds < 0.0]):
        if each.size > 10:
            low, high = np.quantile(each, [0.1, 0.9])
            spreads.append(float(high / low))
    return max(spreads)


def _sliding_velocities(record: Record, half_range: float) -> Array:
    u = record.u
    turns = reversals(u, 0.1 * float(np.ptp(u)))
    strokes = np.concatenate([[0], turns, [u.size - 1]]).astype(int)
    width = max(int(SMOOTHED * u.size / max(strokes.size - 1, 1)), 1)
    speed = np.zeros(u.size)
    speed[width:-width] = (u[2 * width :] - u[: -2 * width]) / (2 * width * record.dt)
    stroke = np.clip(np.searchsorted(strokes, np.arange(u.size), side="right") - 1, 0, None)
    ends = strokes[np.minimum(stroke + 1, strokes.size - 1)]
    # Averages over a turn are of two directions.
    clear = np.arange(u.size) < ends - width
    return np.asarray(speed[clear & (np.abs(u - u[strokes[stroke]]) > SLIDING * half_range)])


@dataclass(frozen=True)
class Terms:
    """Which terms of LuGre friction are looked for.

    Parameters
    ----------
    damping
        sigma1 if it is known; None if it is looked for.
    falls, viscous, thins
        Whether there is a Stribeck curve, sigma2 and Fv.
    """

    damping: float | None
    falls: bool
    viscous: bool
    thins: bool


@dataclass(frozen=True)
class SlidingGuess:
    """Friction that is found by least squares for a given way to sliding and given velocities.

    Parameters
    ----------
    miss
        Norm of what is left.
    constants
        sigma0, sigma1, sigma2, Fc, Fs, vs, Fv, vv.
    offset
        Output units.
    """

    miss: float
    constants: tuple[float, ...]
    offset: float


def guesses(overview: Overview, terms: Terms) -> list[SlidingGuess]:
    """Give the best friction for every way to sliding, the best of all first.

    With the share h of its force that Dahl's model of that way reaches, bristles bear about s(v) h,
    so all other constants are weights, none of them negative, of h, v - |v| h, v, h exp(-(v/vs)^2)
    and tanh(v/vv).

    Parameters
    ----------
    overview
        The records.
    terms
        What is looked for.

    Returns
    -------
    list of SlidingGuess
        Those that have a force of sliding.
    """
    v = velocities(overview.data)
    mean = float(np.sqrt(np.mean(v * v)))
    speeds = mean * np.array(SPEEDS)
    found = [
        _best(overview, terms, v, speeds, float(each) * overview.data.half_range)
        for each in TRAVELS
    ]
    return sorted((each for each in found if each.constants[3] > 0.0), key=lambda each: each.miss)


def _best(overview: Overview, terms: Terms, v: Array, speeds: Array, travel: float) -> SlidingGuess:
    """Find the best pair of velocities, all weights from the triangular factor of the columns."""
    h = model_output(overview.data, models.Dahl(1.0 / travel, 1.0))
    count, slip = speeds.size, v - np.abs(v) * h
    falling = h[:, None] * np.exp(-np.square(v[:, None] / speeds))
    columns = np.column_stack([h, slip, v, falling, np.tanh(v[:, None] / speeds)])
    means = columns.mean(axis=0)
    y = overview.sign * overview.data.measured() - (terms.damping or 0.0) * slip
    factor = np.linalg.qr(np.column_stack([columns - means, y - y.mean()]))[1]
    best = SlidingGuess(np.inf, (0.0,) * 8, 0.0)
    for i, j in itertools.product(
        range(count if terms.falls else 1), range(count if terms.thins else 1)
    ):
        wanted = (True, terms.damping is None, terms.viscous, terms.falls, terms.thins)
        chosen = np.array([0, 1, 2, 3 + i, 3 + count + j])[list(wanted)]
        weights, miss = non_negative(factor[:, chosen], factor[:, -1])
        if miss < best.miss:
            by_column = np.zeros(columns.shape[1])
            by_column[chosen] = weights
            coulomb, damping, viscosity = by_column[:3].tolist()
            excess, thinning = by_column[3:][i], by_column[3 + count :][j]
            constants = (
                coulomb / travel,
                damping if terms.damping is None else terms.damping,
                viscosity,
                coulomb,
                coulomb + float(excess),
                float(speeds[i]),
                float(thinning),
                float(speeds[j]),
            )
            offset = overview.sign * float(y.mean() - by_column @ means)
            best = SlidingGuess(miss, constants, offset)
    return best

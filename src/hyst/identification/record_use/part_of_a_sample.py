"""Inputs that come later by a part of a sample."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hyst.signals import reversals

Array = NDArray[np.float64]
Value = TypeVar("Value", bound=np.generic)

SMALLEST_TURN = 1e-3
"""Of the input's range: the corner of a larger turn stays, smaller ones are noise of the drive."""


def lag_in_samples(lag: float, dt: float, own_dt: float) -> float:
    """Give a ``lag`` in samples of ``dt`` in those of ``own_dt``; the same one if they agree."""
    return lag if math.isclose(dt, own_dt, rel_tol=1e-6) else lag * dt / own_dt


def later(u: Array, part: float, keeps_corners: bool = True) -> Array:
    """Give a signal as it would be sampled if it came later by a part of a sample.

    Cubic interpolation between the four samples around, kept between the two next to it. The corner
    of a turn stays, for the memory of plays is made of corners: it is at the sample next to it.

    Parameters
    ----------
    u
        Shape (N,).
    part
        Of a sample, 0 to below 1.
    keeps_corners
        Whether corners stay and nothing goes beyond its neighbours. Not where rates matter: a
        corner kept is a wrong rate at the samples about it.
    """
    if part == 0.0 or u.size < 2:
        return u
    padded = np.concatenate([u[:1], u[:1], u, u[-1:]])
    before, left, right, after = padded[:-3], padded[1:-2], padded[2:-1], padded[3:]
    s = 1.0 - part  # the way from the earlier sample to the later one
    moved = (
        -s * (s - 1.0) * (s - 2.0) / 6.0 * before
        + (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * left
        - (s + 1.0) * s * (s - 2.0) / 2.0 * right
        + (s + 1.0) * s * (s - 1.0) / 6.0 * after
    )
    if not keeps_corners:
        return np.asarray(moved)
    moved = np.clip(moved, np.minimum(left, right), np.maximum(left, right))
    turns = reversals(u, SMALLEST_TURN * float(np.ptp(u)))
    corners = turns if part < 0.5 else np.minimum(turns + 1, u.size - 1)
    moved[corners] = u[turns]
    return np.asarray(moved)


def by_whole_samples(y: NDArray[Value], late: int) -> NDArray[Value]:
    """Give a signal some samples later, its first or last value where there is no other.

    Parameters
    ----------
    y
        Shape (N,).
    late
        Samples; negative for earlier.
    """
    if late == 0:
        return y
    return np.asarray(y[np.clip(np.arange(y.size) - late, 0, y.size - 1)])


def earlier(y: Array, samples: float) -> Array:
    """Give a signal some samples earlier, on the line between two; its ends are held.

    Parameters
    ----------
    y
        Shape (N,).
    samples
        Parts of one included; negative for later.

    Returns
    -------
    numpy.ndarray
        Shape (N,).

    Examples
    --------
    >>> earlier(np.array([0.0, 1.0, 4.0]), 0.5)
    array([0.5, 2.5, 4. ])
    """
    places = np.arange(y.size, dtype=float)
    return np.asarray(np.interp(places + samples, places, y))

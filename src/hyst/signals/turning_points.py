"""Turning points of a signal that survive its noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_not_negative

SMALLEST_SWING = 0.02
"""Share of a range below which a swing is taken for noise of the drive."""


def reversals(u: ArrayLike, dead_band: float = 0.0) -> NDArray[np.intp]:
    """Find the samples at which a signal turns round by more than a dead band D.

    Sample k is a maximum reversal when the signal came up to it by more than D and has since
    gone down from it by more than D, with nothing higher in between:

        u[k] - u[i] > D for some i < k, with u[l] < u[k] for all i <= l < k, and
        u[k] - u[j] > D for some j > k, with u[l] <= u[k] for all k < l <= j.

    A minimum reversal is the same of -u. So maxima and minima alternate, and any two
    successive reversals differ by more than D. Swings of D or less are noise and leave no
    trace. When the extreme value is taken more than once (a plateau, or two equal peaks with a
    dip of at most D between them) the first index is the reversal. The first and the last
    sample are never reversals: the signal did not come to the one, nor leave the other.

    Parameters
    ----------
    u
        Signal, shape (N,), finite.
    dead_band
        D, in units of ``u``, >= 0. With 0 every turning point counts;
        ``suggest_dead_band`` proposes one for a noisy signal.

    Returns
    -------
    numpy.ndarray
        Indices in ``u``, increasing, shape (number of reversals,). Time O(N).

    Raises
    ------
    InputError
        If ``u`` is not a finite vector, or ``dead_band`` is negative or not finite.

    Source
    ------
    Known as hysteresis filtering or gating of turning points in rainflow counting (ASTM E1049).

    Examples
    --------
    >>> u = [0.0, 2.0, 1.9, 2.1, -1.0, -1.0, 3.0]
    >>> reversals(u)
    array([1, 2, 3, 4])
    >>> reversals(u, dead_band=0.5)
    array([3, 4])
    """
    signal = finite_vector(u, "u")
    dead_band = as_not_negative(dead_band, "dead_band")
    turning = _turning_points(signal)
    if dead_band == 0.0:
        return turning
    # Between two turning points the signal is monotone, so nothing else can set an extreme.
    candidates = np.concatenate(([0], turning, [signal.size - 1]))
    accepted = _gate(signal[candidates].tolist(), float(dead_band))
    return candidates[np.array(accepted, dtype=np.intp)]


def swings_of(u: ArrayLike, extent: float) -> NDArray[np.float64]:
    """Give the ways a signal goes between its turns, those of noise passed over.

    Parameters
    ----------
    u
        Signal, shape (N,), finite.
    extent
        Of which ``SMALLEST_SWING`` is the least way that counts, in units of ``u``, >= 0.

    Returns
    -------
    numpy.ndarray
        Shape (number of reversals - 1,), all positive; empty where there are fewer than two.
    """
    signal = finite_vector(u, "u")
    return np.abs(np.diff(signal[reversals(signal, SMALLEST_SWING * extent)]))


def _turning_points(signal: NDArray[np.float64]) -> NDArray[np.intp]:
    """Strict local extremes, a plateau counting once and by its first index."""
    # Comparing instead of subtracting: a difference can overflow or underflow, an order cannot.
    rises = signal[1:] > signal[:-1]
    moves = np.flatnonzero(rises | (signal[1:] < signal[:-1]))
    direction = rises[moves]
    last_before_turn = np.flatnonzero(direction[1:] != direction[:-1])
    return moves[last_before_turn] + 1


def _gate(values: list[float], dead_band: float) -> list[int]:
    """Positions of the extremes whose swings on both sides exceed the dead band."""
    accepted: list[int] = []
    position, direction = _first_swing(values, dead_band)
    if direction == 0:
        return accepted
    extreme = values[position]
    for index in range(position + 1, len(values)):
        value = values[index]
        if (value - extreme) * direction > 0.0:
            extreme, position = value, index
        elif (extreme - value) * direction > dead_band:
            accepted.append(position)
            extreme, position, direction = value, index, -direction
    return accepted


def _first_swing(values: list[float], dead_band: float) -> tuple[int, int]:
    """Where the signal first spans more than the dead band, and its direction (0: nowhere)."""
    lowest = highest = values[0]
    for index, value in enumerate(values):
        lowest, highest = min(lowest, value), max(highest, value)
        if value - lowest > dead_band:
            return index, 1
        if highest - value > dead_band:
            return index, -1
    return 0, 0

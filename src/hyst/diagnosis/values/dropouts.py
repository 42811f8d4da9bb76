"""Dropouts: stretches where a signal stands on one value although the path went on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.values.runs import Runs, runs_of_equals, samples_of
from hyst.signals import reversals, suggest_dead_band

Array = NDArray[np.float64]
Samples = NDArray[np.intp]

_SHORTEST_HOLD = 4
_SHORTEST_AWAY = 3
_LEAST_JUMP = 0.01
_LEAST_MOTION = 0.005
_TIMES_USUAL = 8.0
_GAIN = 4.0
_LAG = 4
_MOST_STANDING = 0.2
_SIDE = 12
_LONGEST_SHARE = 0.1


@dataclass(frozen=True, eq=False)
class Dropouts:
    """Stretches in which the signal was not measured.

    Parameters
    ----------
    samples
        Shape (m,), ascending.
    values
        Shape (n,), on which the signal stands in each stretch.
    largest_jump
        By which it goes back to its path at most, in units of the signal.
    """

    samples: Samples
    values: Array
    largest_jump: float


def dropouts_in(signal: Array, cause: Array, step: float = 0.0) -> Dropouts:
    """Find stretches of one value, to the bit, which the signal leaves by a jump.

    The jump must bring the signal to where its path leads in the meantime; so a play that stands
    still, which goes on from where it stood, is no dropout. A stretch counts when the cause moved
    during it and did not jump at its end, and either

        it holds the last value (no jump into it), inside the range and without a turn, or
        it was jumped to and back from, as a zero in the midst of a signal.

    Parameters
    ----------
    signal, cause
        Output and input, shape (N,), finite.
    step
        Of the converter, in units of the signal, 0 if there is none.

    Returns
    -------
    Dropouts
    """
    spread = float(np.ptp(signal))
    first, last = _worth_a_look(signal, cause)
    steps = np.abs(np.diff(signal))
    jump = steps[last] if last.size else np.empty(0)
    usual = float(np.median(steps)) if steps.size else 0.0
    large = jump > max(_LEAST_JUMP * spread, 5.0 * step, _TIMES_USUAL / 3.0 * usual)
    holds = [
        place
        for place in np.flatnonzero(large).tolist()
        if _is_dropout(signal, cause, int(first[place]), int(last[place]))
    ]
    holds = _not_between_turns(cause, first, last, holds)
    stood: Runs = (first[holds], last[holds])
    return Dropouts(samples_of(stood), signal[stood[0]], float(np.max(jump[holds], initial=0.0)))


def _worth_a_look(signal: Array, cause: Array) -> Runs:
    """Stretches of one value with samples on both sides, none if the signal mostly stands."""
    nothing = np.empty(0, dtype=np.intp)
    first, last = runs_of_equals(signal)
    length = last - first + 1
    long_enough = (length <= max(_LONGEST_SHARE * signal.size, 2)) & (length >= _SHORTEST_AWAY)
    # Few levels, or a coarse converter: standing is what such a signal does.
    moving = (signal > signal.min()) & (signal < signal.max())
    standing = length[(length >= 3) & moving[first]].sum()
    if standing > _MOST_STANDING * np.count_nonzero(moving):
        return nothing, nothing
    inside = (first >= 4) & (last < signal.size - 4)
    keep = inside & long_enough
    return first[keep], last[keep]


def _not_between_turns(cause: Array, first: Samples, last: Samples, holds: list[int]) -> list[int]:
    """Leave out stretches that begin and end where the cause turns, as those of friction do."""
    if not holds:
        return []
    turns = reversals(cause, suggest_dead_band(cause))
    is_turn = np.zeros(cause.size + 2 * _LAG, dtype=bool)
    for lag in range(_LAG):
        is_turn[turns + lag] = True
    return [place for place in holds if not (is_turn[first[place]] and is_turn[last[place] + 1])]


def _is_dropout(signal: Array, cause: Array, first: int, last: int) -> bool:
    """Whether a stretch ends as one that was not measured."""
    length = last - first + 1
    side = int(np.clip(length, 3, _SIDE))
    left = signal[max(first - side, 0) : first]
    right = signal[last + 1 : last + 1 + side]
    usual = max(
        float(np.median(np.abs(np.diff(left)))),
        float(np.median(np.abs(np.diff(right)))),
    )
    usual = max(usual, float(np.median(np.abs(np.diff(signal)))) / 2.0)
    leaves = float(signal[last + 1] - signal[last])
    enters = float(signal[first] - signal[first - 1])
    if abs(leaves) < _TIMES_USUAL * usual / (1.0 if length < _SHORTEST_HOLD else 3.0):
        return False
    if not _cause_goes_on(cause, first, last):
        return False
    if enters * leaves < 0.0 and abs(enters) > _TIMES_USUAL * usual:
        away = min(abs(enters), abs(leaves))
        comes_back = abs(float(right[0] - left[-1])) < away / 2.0
        pace = float(np.max(np.abs(np.diff(cause[first - 2 : last + 3])))) / float(np.ptp(cause))
        return comes_back and away > _GAIN * pace * float(np.ptp(signal))
    return length >= _SHORTEST_HOLD and _catches_up(signal, cause, first, last, left, right)


def _cause_goes_on(cause: Array, first: int, last: int) -> bool:
    """Whether the cause moves during a stretch and does not jump around its end."""
    moved = float(np.ptp(cause[first : last + 2]))
    if moved <= _LEAST_MOTION * float(np.ptp(cause)):
        return last - first < _SHORTEST_HOLD and moved > 0.0
    near = np.abs(np.diff(cause[max(first - _SIDE, 0) : last + 2 + _SIDE]))
    at_ends = np.abs(np.diff(cause[max(first - 4, 0) : last + 3]))
    return float(at_ends.max()) <= 4.0 * float(np.median(near))


def _catches_up(
    signal: Array, cause: Array, first: int, last: int, left: Array, right: Array
) -> bool:
    """Whether the path before and behind a stretch explains the jump at its end."""
    value = float(signal[first])
    if value in (float(signal.min()), float(signal.max())):
        return False
    turns = np.diff(cause[first - 2 : last + 3])
    if np.any(turns > 0.0) and np.any(turns < 0.0):
        return False
    slopes = (
        float(left[-1] - left[0]) / (left.size - 1),
        float(right[-1] - right[0]) / (right.size - 1),
    )
    missed = float(signal[last + 1] - value) / (last - first + 1)
    return all(0.3 <= slope / missed <= 3.0 for slope in slopes)

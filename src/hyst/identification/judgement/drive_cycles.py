"""Branches of a drive: how many cycles a record holds, and how fast each branch was run."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.remainder import Part
from hyst.signals import reversals

Array = NDArray[np.float64]

SMALLEST_TURN = 0.05
"""Of the input's range of the record: smaller turns are no branches."""


def turns_of(part: Part) -> NDArray[np.intp]:
    """Give the samples at which the drive of a part turns."""
    return np.asarray(reversals(part.u, SMALLEST_TURN * float(np.ptp(part.u))), dtype=np.intp)


def cycles_of(part: Part) -> float:
    """Give the number of cycles of the drive."""
    return turns_of(part).size / 2.0


def frequency_of(part: Part) -> float:
    """Give the mean frequency of the drive between its first turn and its last, Hz."""
    turns = turns_of(part)
    if turns.size < 2:
        return 0.5 / (part.u.size * part.dt)
    return float((turns.size - 1) / (2.0 * (turns[-1] - turns[0]) * part.dt))


def octaves_of(parts: Sequence[Part]) -> float:
    """Give how far the frequencies of branches are apart, octaves, the extreme ones left out."""
    octaves = np.concatenate([np.log2(branch_frequencies(each)) for each in parts])
    low, high = np.percentile(octaves, [5.0, 95.0])
    return float(high - low)


def swings_alike(parts: Sequence[Part]) -> bool:
    """Tell whether all branches between two turns are of one size, within a tenth."""
    swings = [np.abs(np.diff(each.u[turns_of(each)])) for each in parts]
    sizes = np.concatenate(swings)
    return bool(sizes.size == 0 or sizes.max() <= 1.1 * sizes.min())


def last_turns(part: Part) -> tuple[Array, Array]:
    """Give for every sample the input at the last turn of the drive, and at the one before it.

    Before the first turn the drive is taken to have done what it does after it.
    """
    turns = turns_of(part)
    if turns.size < 2:
        return np.zeros(part.u.size), np.zeros(part.u.size)
    values = part.u[np.concatenate([turns[:2], turns])]
    branch = np.searchsorted(turns, np.arange(part.u.size), side="right") + 1
    return values[branch], values[branch - 1]


def branch_frequencies(part: Part) -> Array:
    """Give for every sample the frequency of a drive whose every branch lasts as long as its own.

    The first and the last branch are not whole; they take the frequency of their neighbours.
    """
    turns = turns_of(part)
    if turns.size < 2:
        return np.full(part.u.size, 0.5 / (part.u.size * part.dt))
    frequencies = 0.5 / (np.diff(turns) * part.dt)
    branch = np.searchsorted(turns, np.arange(part.u.size), side="right") - 1
    return np.asarray(frequencies[np.clip(branch, 0, frequencies.size - 1)])

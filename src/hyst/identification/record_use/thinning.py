"""Fewer samples of a long record, with the memory they need.

Plays remember extremes of their input and forget what happens between two of them, so every turning
point is kept, and of each branch a few samples on the way. Where turning points alone are too many,
some stretches of the record are kept as they are, spread evenly over it, and before each of them
only the extremes that it remembers (those that no later one has wiped out). Long records are
searched and compared in this form; the last fit always takes every sample.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record, reversals

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST_SAMPLES = 20_000

FEWEST_ON_A_BRANCH = 4
"""Samples between two turns, if there are as many: fewer would not show how the branch bends."""

STRETCHES = 8
"""Of a record whose turning points are too many: the amplitude may change along it."""

SMALLEST_TURN = 1e-3
"""Of the input's range: smaller turns count as noise of the drive and are passed over."""


def thinned(data: Data, most: int = MOST_SAMPLES) -> Data:
    """Give the same records with fewer samples.

    Parameters
    ----------
    data
        The records.
    most
        About how many samples to keep, of all records together.

    Returns
    -------
    Data
        ``data`` itself if it has no more samples than that; otherwise records whose output is
        already brought forward, so that their delay is 0.
    """
    total = sum(window.stop for window in data.windows())
    if total <= most:
        return data
    records, starts, counted = [], [], list[NDArray[np.bool_] | None]()
    passes = zip(data.records, data.windows(), data.brought_forward(), data.counted(), strict=True)
    for record, window, y, counts in passes:
        share = max(int(most * window.stop / total), 2 * STRETCHES)
        u = record.u[: window.stop]
        for kept, first in _pieces(u, window.start, share, 2.0 * data.half_range):
            records.append(Record(u[kept], y[kept], record.dt * total / most))
            starts.append(first)
            counted.append(None if counts is None else counts[np.maximum(kept - window.start, 0)])
    return replace(
        data,
        records=tuple(records),
        starts=tuple(starts),
        lag=0.0,
        kept=tuple(counted) if data.kept else (),
        disturbances=(),
        measured_inputs=(),
    )


def _pieces(u: Array, start: int, most: int, span: float) -> list[tuple[Indices, int]]:
    """Give the samples of each piece, and which of them is the first to be compared."""
    turns = _turns(u, span)
    per_branch = most // (turns.size + 1) - 1
    if per_branch >= FEWEST_ON_A_BRANCH:
        kept = _along_branches(u.size, turns, per_branch)
        return [(kept, int(np.searchsorted(kept, start)))]
    length = most // STRETCHES
    firsts = np.linspace(start, u.size - length, STRETCHES).astype(np.intp)
    pieces = []
    for first in firsts:
        past = _remembered(u[: first + 1], SMALLEST_TURN * span)
        stretch = np.arange(first, first + length)
        pieces.append((np.unique(np.concatenate([past, stretch])), int(np.sum(past < first))))
    return pieces


def _turns(u: Array, span: float) -> Indices:
    """Give the turning points, those of noise on the drive passed over."""
    return np.asarray(reversals(u, SMALLEST_TURN * span), dtype=np.intp)


def _along_branches(samples: int, turns: Indices, per_branch: int) -> Indices:
    """Give both ends of every branch and so many samples evenly spaced between them."""
    ends = np.unique(np.concatenate([[0], turns, [samples - 1]]))
    shares = np.arange(per_branch + 1) / (per_branch + 1)
    places = ends[:-1, None] + shares * np.diff(ends)[:, None]
    return np.unique(np.append(np.round(places).astype(np.intp), samples - 1))


def _remembered(u: Array, tolerance: float) -> Indices:
    """Give the extremes of an input that later ones have not wiped out, and its last sample.

    A loop inside another is passed over while it is smaller by less than the tolerance.
    """
    places = _extremes_left(u)
    values = u[places]
    chosen, last = [0, 1][: places.size], 1
    for i in range(2, places.size - 1, 2):
        shrunk = abs(values[i] - values[last - 1]) + abs(values[i + 1] - values[last])
        if shrunk > tolerance and i + 1 < places.size - 1:
            chosen += [i, i + 1]
            last = i + 1
    # From the last whole loop to the present: one branch, or a turn and the branch after it.
    open_end = places[-1:] if places.size % 2 else places[-2:]
    return np.unique(np.concatenate([places[chosen], open_end]))


def _extremes_left(u: Array) -> Indices:
    """Give the extremes that later ones have not wiped out, and the last sample.

    From the last extreme of all on, each is the highest or lowest of what comes after the one
    before; the first of equals. The highest of every rest is found once, backwards.
    """
    highest, lowest = int(u.argmax()), int(u.argmin())
    kept = sorted({highest, lowest})
    base = kept[-1] + 1
    highs, lows = _records_from_the_end(u[base:]), _records_from_the_end(-u[base:])
    rises = kept[-1] == lowest
    while kept[-1] < u.size - 1:
        records = highs if rises else lows
        next_one = np.searchsorted(records, kept[-1] + 1 - base)
        kept.append(base + int(records[next_one]))
        rises = not rises
    return np.array(kept, dtype=np.intp)


def _records_from_the_end(u: Array) -> Indices:
    """Give where a signal is at least as high as everything after it.

    The first of these from any place on is the highest sample of that rest, the first of equals.
    """
    return np.flatnonzero(u == np.maximum.accumulate(u[::-1])[::-1])

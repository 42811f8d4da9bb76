"""Stretches of long records: some spread evenly, some where the output moves most.

The beginning of a record may show a part of its frequencies only, as that of a chirp.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import LARGEST_RADIUS, Data
from hyst.signals import Record

Array = NDArray[np.float64]

_EVEN, _STRONGEST = 6, 6
_PLACES = 16
_NOT_WORTH = 1.5  # times the samples wanted: all are taken
_FEWEST = 6  # of a record whose memory settles just before them, or its beginning serves


def spread(data: Data, samples: int) -> Data:
    """Give stretches of the records, each with as much before it as settles its memory.

    Where few can have it, as with random drives, one stretch is taken.

    Parameters
    ----------
    data
        The records.
    samples
        To be compared in all.

    Returns
    -------
    Data
        ``data`` itself if its records are hardly longer.
    """
    lengths = [w.stop - w.start for w in data.windows()]
    if sum(lengths) <= _NOT_WORTH * samples:
        return data
    records, starts, kept, smoothers = [], [], [], []
    for number, record in enumerate(data.records):
        share = max(int(samples * lengths[number] / sum(lengths)), 1000)
        for begin, first, end in _stretches_of(data, number, share):
            records.append(record.slice(begin, end))
            starts.append(first - begin)
            mask = data.kept[number] if data.kept else None
            kept.append(None if mask is None else mask[begin:end])
            smoothers.append(data.smoothers[number] if data.smoothers else None)
    return replace(
        data,
        records=tuple(records),
        starts=tuple(starts),
        kept=tuple(kept) if data.kept else (),
        smoothers=tuple(smoothers) if data.smoothers else (),
        disturbances=(),
        measured_inputs=(),
        past=(),
    )


def _stretches_of(data: Data, number: int, samples: int) -> list[tuple[int, int, int]]:
    """Give where each stretch's past begins, where it itself does, and where it ends."""
    record, window = data.records[number], data.windows()[number]
    length = samples // (_EVEN + _STRONGEST)
    places = range(window.start, window.stop - length + 1, length)
    if len(places) <= _EVEN + _STRONGEST:
        return [(0, window.start, window.stop)]
    even = set(np.linspace(0, len(places) - 1, _EVEN).astype(int).tolist())
    moves = np.array([float(np.var(record.y[each : each + length])) for each in places])
    strongest = [int(i) for i in np.argsort(-moves, kind="stable") if int(i) not in even]
    chosen = sorted(even | set(strongest[:_STRONGEST]))
    pasts = [(_past_of(record, places[i], length), places[i]) for i in chosen]
    found = [(past, first, first + length) for past, first in pasts if past is not None]
    if len(found) < _FEWEST:  # a random drive, of which one part shows what all of it does
        return [_with_shortest_past(record, window, samples)]
    return found


def _with_shortest_past(record: Record, window: slice, samples: int) -> tuple[int, int, int]:
    """Give one stretch, where the least before it settles its memory: all of that is run, too."""
    last = max(window.stop - samples, window.start)
    firsts = np.unique(np.linspace(window.start, last, _PLACES).astype(int)).tolist()
    pasts = [(_past_of(record, each, each), each) for each in firsts]
    known = [(first - past, past, first) for past, first in pasts if past is not None]
    if not known:
        return 0, window.start, min(window.start + samples, window.stop)
    _, past, first = min(known)
    return past, first, min(first + samples, window.stop)


def _past_of(record: Record, first: int, longest: int) -> int | None:
    """Give from where on the memory at a sample is known; None if that is too far back."""
    begin = max(first - longest, 0)
    u = record.u[begin : first + 1][::-1]
    covered = np.maximum.accumulate(u) - np.minimum.accumulate(u)
    enough = covered >= LARGEST_RADIUS * float(np.ptp(record.u))
    return first - int(enough.argmax()) if enough.any() else None

"""Fewer samples of a long record, with the memory they need.

A play remembers extremes of its input, so a record may be thinned if the extremes stay: of each
stretch the first sample, the lowest and the highest are kept, in their order. Only loops smaller
than the input's range within one stretch are lost, and with them what plays of such small radii
would remember of them. Long records are searched and compared in this form; the last fit always
takes every sample.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record

Array = NDArray[np.float64]

MOST_SAMPLES = 20_000


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
    stretch = int(np.ceil(3.0 * total / most))
    records, starts = [], []
    for record, window in zip(data.records, data.windows(), strict=True):
        kept = _extremes(record.u[: window.stop], stretch)
        records.append(Record(record.u[kept], record.y[kept + data.delay], record.dt * stretch))
        starts.append(int(np.searchsorted(kept, window.start)))
    return Data(tuple(records), tuple(starts), 0, data.half_range, data.settled)


def _extremes(u: Array, stretch: int) -> NDArray[np.intp]:
    """Give the indices of the first, lowest and highest sample of every stretch, ascending."""
    whole = u.size // stretch
    rows = u[: whole * stretch].reshape(whole, stretch)
    first = np.arange(whole) * stretch
    rest = np.arange(whole * stretch, u.size)
    lowest, highest = first + rows.argmin(axis=1), first + rows.argmax(axis=1)
    return np.unique(np.concatenate([first, lowest, highest, rest]))

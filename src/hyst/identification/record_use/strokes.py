"""Strokes of the input, from turn to turn, and whether they show minor loops."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import Data
from hyst.signals import reversals

Array = NDArray[np.float64]

SMALLEST_STROKE = 0.02
"""Of the input's range: turns of less are noise of the drive."""

INNER = 0.75
"""Strokes up to this share of the longest one run inside its loop."""

FEWEST_INNER = 0.15
"""Of the samples, in inner strokes of a record that shows minor loops."""

OUTERMOST = 0.9
"""Strokes from this share of the longest one on make the outermost loop."""


def stroke_lengths(data: Data) -> Array:
    """Give the length of the stroke that every sample used belongs to.

    Parameters
    ----------
    data
        The records.

    Returns
    -------
    numpy.ndarray
        Shape (samples used,), input units.
    """
    parts = []
    for record, window in zip(data.records, data.windows(), strict=True):
        u = record.u[: window.stop]
        turns = reversals(u, SMALLEST_STROKE * 2.0 * data.half_range)
        ends = np.unique(np.concatenate([[0], turns, [u.size - 1]]))
        swings = np.abs(np.diff(u[ends]))
        # What begins or ends the record is no whole stroke: its neighbour says what it belongs to.
        if swings.size > 2:
            swings[0], swings[-1] = max(swings[:2]), max(swings[-2:])
        of = np.clip(np.searchsorted(ends, np.arange(u.size), side="right") - 1, 0, swings.size - 1)
        parts.append(swings[of][window])
    return data.joined(parts)


def shows_minor_loops(lengths: Array) -> bool:
    """Tell whether enough of a record runs inside its largest loop to judge minor loops by.

    Parameters
    ----------
    lengths
        Of ``stroke_lengths``.
    """
    return bool(np.mean(lengths <= INNER * lengths.max()) >= FEWEST_INNER)

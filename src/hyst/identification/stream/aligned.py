"""Input and output of a record in a file, sample by sample side by side, block by block."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.evaluation import BLOCK
from hyst.identification.stream.survey import chunks_of
from hyst.signals.record_stream import RecordStream

Array = NDArray[np.float64]


def aligned(stream: RecordStream, late: int) -> Iterator[tuple[Array, Array]]:
    """Give the input with the output that it moves, in blocks.

    Parameters
    ----------
    stream
        The record.
    late
        Samples by which its output comes after its input; where it is ahead, the first samples
        have no output and are NaN.

    Yields
    ------
    tuple of numpy.ndarray
        Input and output, shape (n,).
    """
    skipped = max(late, 0)
    u_left, y_left = np.empty(0), np.full(max(-late, 0), np.nan)
    for u, y in chunks_of(stream):
        dropped = min(skipped, y.size)
        skipped -= dropped
        u_left, y_left = np.concatenate([u_left, u]), np.concatenate([y_left, y[dropped:]])
        both = min(u_left.size, y_left.size)
        for first in range(0, both, BLOCK):
            rows = slice(first, min(first + BLOCK, both))
            yield u_left[rows], y_left[rows]
        u_left, y_left = u_left[both:], y_left[both:]

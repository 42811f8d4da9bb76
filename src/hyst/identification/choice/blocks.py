"""Which samples are left out together: stretches of time, and strokes of like length.

A record of one amplitude repeats itself, so its stretches are no independent witnesses and say
nothing of other amplitudes. Where strokes of several lengths are there, classes of them are left
out as well; but the outermost ones never are, for nothing else shows how the model bends there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.strokes import OUTERMOST

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]
Numbers = NDArray[np.intp]

MOST_BLOCKS = 8
FEWEST_BLOCKS = 2
SMALLEST_BLOCK = 5
"""Samples; each block is scored with a free offset, so one alone would always fit."""


@dataclass(frozen=True, eq=False)
class Block:
    """Samples that are left out together.

    Parameters
    ----------
    rows
        Shape (samples used,), true for those left out.
    stretch
        Shape (samples left out,): the stretch of time each is in, which has its own offset.
    """

    rows: Rows
    stretch: Numbers


def blocks_of(overview: Overview) -> list[Block]:
    """Give the blocks that a family is judged on, one after the other.

    Parameters
    ----------
    overview
        The records.

    Returns
    -------
    list of Block
        Up to eight stretches of time; of a record that shows minor loops half of them classes of
        strokes, by length.
    """
    samples = overview.input.size
    count = max(FEWEST_BLOCKS, min(MOST_BLOCKS, samples // SMALLEST_BLOCK))
    if not overview.shows_minor_loops or count < MOST_BLOCKS:
        return _stretches(samples, count)
    stretches = _stretches(samples, count // 2)
    stretch_of = np.arange(samples) * (count // 2) // samples
    classes = _classes(overview.stroke_lengths, count // 2)
    return [*stretches, *(Block(rows, stretch_of[rows]) for rows in classes)]


def _stretches(samples: int, count: int) -> list[Block]:
    stretch_of = np.arange(samples) * count // samples
    return [Block(stretch_of == each, stretch_of[stretch_of == each]) for each in range(count)]


def _classes(lengths: Array, count: int) -> list[Rows]:
    """Part the inner strokes into classes of about as many samples, whole strokes in each."""
    inner = lengths < OUTERMOST * lengths.max()
    ordered = np.sort(lengths[inner])
    edges = ordered[np.arange(1, count) * ordered.size // count]
    class_of = np.searchsorted(edges, lengths, side="right")
    classes = [inner & (class_of == each) for each in range(count)]
    return [rows for rows in classes if rows.sum() >= SMALLEST_BLOCK]

"""A first guess of two envelopes: the branches of the largest loop, up and down."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.envelope_layout import EnvelopeLayout
from hyst.identification.families.play_layout import SMALLEST_MAP_SLOPE
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.record_use.overview import Overview

Array = NDArray[np.float64]

LARGE = 0.8
"""Strokes of at least this share of the largest one run along the envelopes."""
FEWEST = 3
"""Samples a slope of a branch that make it worth a guess."""
PART_WITHOUT_MEMORY = 0.1
SPREAD = 0.5
"""How much wider the last play is than the first."""


def guess_of_branches(overview: Overview, layout: EnvelopeLayout, n: int) -> Array | None:
    """Give theta of plays pushed along the branches of the largest loop, or None.

    A branch up is ``P (up - r)``, a branch down ``P (down + r)``, P the sum of the weights; the
    slope of ``up`` around 0 is 1.

    Parameters
    ----------
    overview
        The records.
    layout
        Of the slopes.
    n
        Number of plays.
    """
    u = overview.input
    y = overview.sign * overview.data.measured()
    large = overview.stroke_lengths >= LARGE * overview.stroke_lengths.max()
    rises = np.gradient(u) > 0.0
    branches = [_branch(u[rows], y[rows], layout.ends) for rows in (large & rises, large & ~rises)]
    if branches[0] is None or branches[1] is None:
        return None
    (up, at_up), (down, at_down) = branches[0], branches[1]
    slopes, unit = layout.of_pieces(up)
    unit = max(unit, SMALLEST_MAP_SLOPE * float(max(up.max(), down.max())))
    if not unit > 0.0:
        return None
    # The gap at the knot next to 0, from which both are counted.
    zero = int(np.argmin(np.abs(layout.ends)))
    rise = float(up[:zero] @ np.diff(layout.ends)[:zero]) + at_up
    fall = float(down[:zero] @ np.diff(layout.ends)[:zero]) + at_down
    r = max(fall - rise, 1e-3 * float(np.ptp(y))) / (2.0 * unit)
    weights = np.full(n, unit * (1.0 - PART_WITHOUT_MEMORY) / n)
    radii = r * (1.0 + SPREAD * np.arange(n) / n)
    return np.concatenate(
        [[PART_WITHOUT_MEMORY * unit], weights, radii, slopes / unit, down / unit, [0.0]]
    )


def _branch(u: Array, y: Array, ends: Array) -> tuple[Array, float] | None:
    """Slopes of 0 or more between knots by least squares, and the value at the first knot."""
    if u.size < FEWEST * ends.size:
        return None
    columns = np.clip(u[:, None] - ends[:-1], 0.0, np.diff(ends))
    middle = columns.mean(axis=0)
    scale = np.maximum(np.abs(columns - middle).max(axis=0), np.finfo(np.float64).tiny)
    slopes = non_negative((columns - middle) / scale, y - y.mean())[0] / scale
    return slopes, float(y.mean() - middle @ slopes)

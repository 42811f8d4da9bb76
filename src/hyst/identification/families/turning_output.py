"""How far an output goes back on one branch of its loop: what makes a butterfly one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

BINS = 24
"""Into which the range of the input is divided; a mean over each hides the noise."""

EXPLAINED = 0.3
"""Share of the output's variance that the mean loop must explain, or there is no loop to judge."""


def turning_share(data: Data) -> float:
    """Give by how much of its range the output goes back on a branch and in the middle of the loop.

    A lag makes branches turn back, too, but leaves the middle of the loop as it is.

    Parameters
    ----------
    data
        The records.

    Returns
    -------
    float
        0 where the output goes one way while the input does, or follows no loop; 1 where it goes
        all the way there and back.
    """
    y = np.concatenate(data.outputs())
    u = np.concatenate([r.u[w] for r, w in zip(data.records, data.windows(), strict=True)])
    way = np.concatenate(
        [np.gradient(r.u)[w] for r, w in zip(data.records, data.windows(), strict=True)]
    )
    span, spread = float(np.ptp(y)), float(np.sum((y - y.mean()) ** 2))
    if span == 0.0:
        return 0.0
    place = np.minimum((u - u.min()) / np.ptp(u) * BINS, BINS - 1).astype(np.intp)
    branches, explained = [], 0.0
    for here in (way > 0.0, way < 0.0):
        count = np.bincount(place[here], minlength=BINS)
        mean = np.bincount(place[here], y[here], minlength=BINS) / np.maximum(count, 1)
        explained += float(np.sum(count * (mean - y.mean()) ** 2))
        branches.append(np.where(count > 0, mean, np.nan))
    if explained < EXPLAINED * spread:
        return 0.0
    middle = 0.5 * (branches[0] + branches[1])
    return min(max(_goes_back(each) for each in branches), _goes_back(middle)) / span


def _goes_back(curve: Array) -> float:
    """How far a curve goes there and back, without the places that are not known."""
    known = curve[np.isfinite(curve)]
    return min(_way_up(known), _way_up(-known)) if known.size else 0.0


def _way_up(values: Array) -> float:
    """How far a curve goes up where it goes furthest without coming back."""
    return float((values - np.minimum.accumulate(values)).max())

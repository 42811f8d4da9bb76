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
    """Give by how much of its range the output goes back on a branch of the mean loop.

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
    back, explained = 0.0, 0.0
    for here in (way > 0.0, way < 0.0):
        place = np.minimum((u[here] - u.min()) / np.ptp(u) * BINS, BINS - 1).astype(np.intp)
        count = np.bincount(place, minlength=BINS)
        seen = count > 0
        mean = np.bincount(place, y[here], minlength=BINS)[seen] / count[seen]
        explained += float(np.sum(count[seen] * (mean - y.mean()) ** 2))
        if mean.size:
            back = max(back, min(_way_up(mean), _way_up(-mean)))
    return back / span if explained >= EXPLAINED * spread else 0.0


def _way_up(values: Array) -> float:
    """How far a curve goes up where it goes furthest without coming back."""
    return float((values - np.minimum.accumulate(values)).max())

"""Plays so wide that the records move them once: what a second time would do is not shown."""

from __future__ import annotations

import numpy as np

from hyst.identification.families.play_layout import half_swings
from hyst.identification.record_use.used_samples import Data
from hyst.models import PrandtlIshlinskii
from hyst.operators import Operator
from hyst.operators.composition import leaves_of

WORTH_TELLING = 0.01
"""Of the output's range, what such plays can move the output by."""


def about_seldom_moved(operator: Operator, data: Data) -> tuple[str, ...]:
    """Say by how much plays that at most one stroke has moved can move the output.

    Parameters
    ----------
    operator
        The model.
    data
        The records, in the units of the model.

    Returns
    -------
    tuple of str
        A sentence, or none.
    """
    plays = next(
        (each for each in leaves_of(operator) if isinstance(each, PrandtlIshlinskii)), None
    )
    if plays is None or not plays.r.size:
        return ()
    windows = zip(data.records, data.windows(), strict=True)
    used = np.concatenate([half_swings(operator, each.u[window]) for each, window in windows])
    low = min(float(each.u.min()) for each in data.records)
    high = max(float(each.u.max()) for each in data.records)
    widest = float(half_swings(operator, np.array([low, high, low, high])).max(initial=0.0))
    moved = np.count_nonzero(used[:, None] > plays.r[None, :], axis=0)
    seldom = (moved <= 1) & (plays.r < widest)
    p, r = plays.p[seldom], plays.r[seldom]
    # What they add to a stroke is straight between radii, so that it is largest at one of them.
    strokes = np.append(r, widest)
    added = 2.0 * np.maximum(strokes[:, None] - r[None, :], 0.0) @ p
    share = float(np.abs(added).max()) / float(np.ptp(data.measured()))
    if share < WORTH_TELLING:
        return ()
    return (
        f"plays of radius {float(r.min()):.4g} or more are moved by one stroke of the records at "
        f"most, and add {100.0 * share:.2g} % of the output's range to a sweep of the whole range: "
        "after one the model may be off by as much; record some loops over the whole range before "
        "smaller ones",
    )

"""How far a loop opens, roughly and quickly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_PLACES = 20


def widest_opening(cause: Array, signal: Array) -> float:
    """Give the largest distance of the means of the output where the input rises and falls.

    Parameters
    ----------
    cause, signal
        Input and output, shape (N,), finite.

    Returns
    -------
    float
        In units of the signal; 0 where the input does not go both ways.
    """
    stroke = float(np.ptp(cause))
    if stroke == 0.0 or cause.size < 2:
        return 0.0
    place = np.minimum(((cause - cause.min()) / stroke * _PLACES).astype(np.intp), _PLACES - 1)
    moves = np.diff(cause)
    means = []
    for way in (moves > 0.0, moves < 0.0):
        cells, values = place[1:][way], signal[1:][way]
        number = np.bincount(cells, minlength=_PLACES)
        sums = np.bincount(cells, values, minlength=_PLACES)
        means.append(np.where(number > 0, sums / np.maximum(number, 1), np.nan))
    gaps = np.abs(means[0] - means[1])
    return float(np.nanmax(gaps)) if np.any(np.isfinite(gaps)) else 0.0

"""What models that describe a record about as well say of a drive it did not contain."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

STROKE = 25
"""Samples of a stroke."""

LEVELS = (0.0, 0.5, -0.5, 0.25, -0.25)
"""Where the nested loops shrink to, in halves of the input's range around its middle."""

SIZES = (0.75, 0.5, 0.3, 0.15)
"""Of the loops around a level, as shares of the way to the nearer end."""

WHOLE = (1.0, -1.0, 1.0)
"""Strokes over the whole range, after which memory is known."""


def nested_drive(data: Data) -> tuple[Array, int]:
    """Give loops that shrink around several levels within the range of the records.

    Parameters
    ----------
    data
        The records.

    Returns
    -------
    u : numpy.ndarray
        Shape (N,), input units.
    start : int
        First sample after the strokes over the whole range.
    """
    low = min(float(each.u.min()) for each in data.records)
    high = max(float(each.u.max()) for each in data.records)
    turns = [0.0, *WHOLE]
    for level in LEVELS:
        reach = 1.0 - abs(level)
        for size in SIZES:
            turns += [level - size * reach, level + size * reach]
        turns += [-1.0, 1.0]
    strokes = [np.linspace(a, b, STROKE, endpoint=False) for a, b in itertools.pairwise(turns)]
    shape = np.concatenate([*strokes, turns[-1:]])
    return 0.5 * (low + high) + 0.5 * (high - low) * shape, len(WHOLE) * STROKE


def disagreement(fit: Fit, rivals: Sequence[Fit], data: Data) -> float:
    """Give how far apart models are on nested minor loops.

    Parameters
    ----------
    fit
        The one taken.
    rivals
        The others, one of each kind.
    data
        The records.

    Returns
    -------
    float
        Root mean square of the largest difference to a rival, an offset aside, output units; 0
        without rivals.
    """
    u, start = nested_drive(data)
    taken = fit.operator(u)[start:]
    apart = [float(np.std(each.operator(u)[start:] - taken)) for each in rivals]
    return max(apart, default=0.0)

"""Drives from point to point: triangles, reversal curves, stairs, binary sequences.

A leg takes as few samples as the limits allow. With a limit of the acceleration it speeds up and
slows down evenly and rests one sample at each point.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.signals.drive import Limits, require_length

Array = NDArray[np.float64]


def path(points: Sequence[float] | Array, dt: float, limits: Limits, hold: int = 0) -> Array:
    """Go from point to point within limits.

    Parameters
    ----------
    points
        Values to pass, the first is where it starts.
    dt
        Sample time, s.
    limits
        The rate must be limited.
    hold
        Samples to rest at each point.

    Returns
    -------
    numpy.ndarray
        Shape (N,).

    Raises
    ------
    InputError
        If the rate is not limited, or the path would be longer than 1e8 samples.

    Examples
    --------
    >>> path([0.0, 1.0, 0.0], 1.0, Limits(max_rate=0.5000001)).tolist()
    [0.0, 0.5, 1.0, 0.5, 0.0]
    """
    if math.isinf(limits.max_rate):
        raise InputError("max_rate is not given; a path from point to point needs one")
    values = np.asarray(points, dtype=np.float64)
    largest = float(np.abs(values).max())
    step, bend = limits.step(dt, largest), limits.bend(dt, largest)
    require_length(float(np.abs(np.diff(values)).sum()) / step + values.size * float(hold))
    pieces = [values[:1], np.full(hold, values[0])]
    rest = max(hold, 0 if math.isinf(limits.max_acceleration) else 1)
    for start, end in pairwise(values):
        leg = _leg(float(end - start), step, bend)
        # The end itself, not a sum: a turning point is where it was asked for.
        pieces += [start + leg[:-1], np.full(1 + rest, end)]
    return np.concatenate(pieces)


def _leg(distance: float, step: float, bend: float) -> Array:
    """Positions after each sample of a leg, the last one ``distance``."""
    length = abs(distance)
    if length == 0.0:
        return np.zeros(1)
    if math.isinf(bend):
        # The rounding of a position must not break the limit of the rate.
        count = math.ceil(length / step * (1.0 - 1e-13))
        return distance * np.arange(1, count + 1) / count
    top = step / bend
    count = max(1, math.ceil(2.0 * math.sqrt(length / bend)) - 2, math.ceil(length / step))
    while True:
        k = np.arange(1, count + 1)
        rates = np.minimum(np.minimum(k, count + 1 - k), top)
        reach = bend * float(rates.sum())
        if reach >= length:
            break
        count += max(1, math.ceil((length - reach) / max(step, bend)) // 2)
    return distance * np.cumsum(rates) / float(rates.sum())

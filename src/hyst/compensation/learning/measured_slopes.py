"""Slopes of the plant behind the model's inverse along a motion, as measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_WINDOWS = 40
"""Of a motion; within each the slope is taken for one number."""

_ENDS = 0.05
"""Of the windows that are left aside at either end, as the noise makes outliers of some."""

_CLEAR = 20.0
"""Times the noise: the way within a window whose slope is asked for."""

_STILL = 5e-4
"""Of the range of the motion: noise that is reckoned with, also where less is claimed."""


def measured_slopes(expected: Array, y: Array, noise: float) -> tuple[float, float] | None:
    """Give the least and the largest slope of y over what the linear part gives.

    Parameters
    ----------
    expected, y
        Shape (N,), of one repetition, or differences between two.
    noise
        Rms of what does not repeat in y.

    Returns
    -------
    tuple of float or None
        None where too little moves to tell.
    """
    length = max(expected.size // _WINDOWS, 4)
    noise = max(noise, _STILL * float(np.ptp(expected)))
    slopes = []
    for first in range(0, expected.size - length + 1, length):
        x, own = expected[first : first + length], y[first : first + length]
        x, own = x - x.mean(), own - own.mean()
        way = float(x @ x)
        if way > length * (_CLEAR * noise) ** 2 / 12.0 and way > 0.0:
            slopes.append(float(x @ own) / way)
    if len(slopes) < 4:
        return None
    low, high = np.quantile(slopes, [_ENDS, 1.0 - _ENDS])
    return float(low), float(high)

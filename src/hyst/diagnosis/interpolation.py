"""A signal a part of a sample earlier, and what that does to its noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Nearer to a whole sample than this there is nothing to interpolate.
WHOLE = 0.01


def earlier(signal: Array, lag: float) -> tuple[Array, float]:
    """Give ``signal(k - lag)`` for k from ceil(lag) + 2 on, and the noise power it keeps.

    A cubic through the four samples around it; white noise of variance s^2 becomes ``power s^2``.
    """
    first = first_comparable(lag)
    nearest = round(lag)
    if abs(lag - nearest) <= WHOLE:
        return signal[first - nearest : signal.size - nearest], 1.0
    whole = int(np.ceil(lag))
    weights = _cubic(whole - lag)
    start = first - whole
    count = signal.size - first
    parts = [w * signal[start + i - 1 : start + i - 1 + count] for i, w in enumerate(weights)]
    return parts[0] + parts[1] + parts[2] + parts[3], float(np.sum(np.square(weights)))


def first_comparable(lag: float) -> int:
    """Give the first sample for which ``earlier`` has a value."""
    return int(np.ceil(lag)) + 2


def _cubic(t: float) -> Array:
    """Lagrange's weights of samples -1, 0, 1, 2 at 0 <= t < 1."""
    return np.array(
        [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ]
    )

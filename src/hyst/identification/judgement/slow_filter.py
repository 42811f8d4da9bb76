"""A first-order low pass over a drive."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def low_passed(u: Array, samples: float) -> Array:
    """Let a drive through a first-order low pass that is settled at the first sample.

    Parameters
    ----------
    u
        Shape (n,).
    samples
        Its time constant.
    """
    import scipy.signal  # slow, and only dynamics need it

    keep = float(np.exp(-1.0 / samples))
    passed, _ = scipy.signal.lfilter([1.0 - keep], [1.0, -keep], u, zi=[keep * u[0]])
    return np.asarray(passed)

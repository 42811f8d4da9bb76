"""A first-order low pass over a drive."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.models import LinearDynamics

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
    keep = float(np.exp(-1.0 / samples))
    # By the engine: scipy.signal takes half a second to load.
    passes = LinearDynamics([[keep]], [1.0 - keep], [keep], 1.0 - keep, 1.0, x0=u[:1])
    return passes(u)

"""Extrapolation from the repetitions before: what their differences would explain of an error.

    c = argmin |e - sum c_j (e - e_j)|^2,   v* = v - sum c_j (v - v_j)

the multi-secant step of D. G. Anderson, J. ACM 12 (1965) 547, eqs. 4.1-4.3. It finds in one or two
repetitions that some directions respond by less, or more, than is known, as the mean of a motion
does behind a hysteresis that the model does not have.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_WORTH = 0.85
"""Of the error's rms: what extrapolation must leave at most, or it is not made."""

_MOST = 2.0
"""Of a difference: no direction is gone further along."""

_ALIKE = 1e-3
"""Of the largest: a direction that is told from the others by less is left aside."""


def mixed(
    v: Array, error: Array, before: Sequence[tuple[Array, Array]], noise: float
) -> tuple[Array, Array]:
    """Give where the differences to earlier repetitions lead, and the error expected there.

    Parameters
    ----------
    v, error
        Of the repetition to go on from, shape (N,).
    before
        The same of earlier ones.
    noise
        Rms of what does not repeat.
    """
    if not before:
        return v, error
    dv = np.array([v - each for each, _ in before]).T
    de = np.array([error - each for _, each in before]).T
    left, size, right = np.linalg.svd(de, full_matrices=False)
    own = 2.0 * noise**2 * error.size
    clear = size**2 > np.maximum(9.0 * own, (_ALIKE * size.max()) ** 2)
    if not clear.any():
        return v, error
    c = right.T[:, clear] @ ((left.T[clear] @ error) / size[clear])
    if np.abs(c).max() > _MOST:
        c = c * (_MOST / np.abs(c).max())
    there = error - de @ c
    if float(there @ there) > _WORTH**2 * float(error @ error):
        return v, error
    return v - dv @ c, there

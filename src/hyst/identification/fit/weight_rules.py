"""What the weights of a model may be, as bounds on free coefficients.

``non-negative``: p0, p_1 .. p_n >= 0. Loops turn steep after a reversal, as those of piezos do.
``invertible``: the cumulative weights p0 + .. + p_j >= 0, which is all an inverse needs. Loops may
also flatten after a reversal, as those of friction do. The free coefficients are then these sums,
the slopes of the loading curve, so either rule is a bound at zero.

``sliding``: springs that slide, p0 = k0 + sum k and p = -k with k0, k >= 0. The free coefficients
are the stiffnesses.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NON_NEGATIVE, INVERTIBLE = "non-negative", "invertible"
RULES = (NON_NEGATIVE, INVERTIBLE)
SLIDING = "sliding"


def basis(rule: str, plays: int) -> Array:
    """Give the matrix B of ``(p0, p) = B a`` for free coefficients a >= 0.

    Parameters
    ----------
    rule
        ``non-negative``, ``invertible`` or ``sliding``.
    plays
        Number of plays n.

    Returns
    -------
    numpy.ndarray
        Shape (n + 1, n + 1), invertible.
    """
    identity = np.eye(plays + 1)
    if rule == SLIDING:
        springs = -identity
        springs[0] = 1.0
        return springs
    return identity if rule == NON_NEGATIVE else identity - np.eye(plays + 1, k=-1)

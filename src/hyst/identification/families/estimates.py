"""What the table of parameters of a result tells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Estimates:
    """Values that follow from the free parameters of a fit.

    Parameters
    ----------
    names, values
        Of each, shape (q,).
    by_theta
        Shape (q, m): their derivative by theta.
    """

    names: tuple[str, ...]
    values: Array
    by_theta: Array

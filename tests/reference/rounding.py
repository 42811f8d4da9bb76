"""How exactly two ways to the same output can be expected to agree."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst import Operator
from reference.numpy_operators import has_twin, simulate


def rounding_of(operator: Operator, u: NDArray[np.float64]) -> float:
    """Give a bound where rounding can be counted, and else what iterative solutions stop at."""
    model = operator.to_dict()
    if has_twin(model):
        return 4.0 * simulate(model, u).rounding
    return 1e-9 * (1.0 + float(np.abs(operator(u)).max()))

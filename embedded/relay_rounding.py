"""Rounding of the Preisach operator: thresholds that are not quite where they were; branches."""

from __future__ import annotations

import numpy as np

from embedded.curve_rounding import UNIT, Passed, deepest
from hyst.models import Preisach

_TERMS = 14
"""Roundings of a branch: shares of its first cell, two entries, line and square, the sum."""


def relay_bound(passage: Passed) -> float:
    """Bound the error of the Preisach operator, not of its inverse.

    Thresholds and inputs that are off shift the output by the operator's Lipschitz constant;
    entries of the table are sums of at most 2 n masses; every branch starts from a rounded
    reversal.
    """
    stage = passage.stage
    edges = np.array(stage.fixed["thresholds"])
    n = edges.size - 1
    weights = np.zeros((n, n))
    weights[np.tril_indices(n)] = passage.constants[1:]
    p0 = float(passage.constants[0])
    density = "ridges" if stage.choices["ridges"] else "even"
    steepest = Preisach(weights, edges, p0, density=density).lipschitz_constant()  # type: ignore[arg-type]
    most = float(np.abs(passage.u).max()) + passage.error
    moved = passage.error + 2.0 * UNIT * float(np.abs(edges).max())
    branch = (2 * n + _TERMS) * UNIT * 2.0 * float(weights.sum()) + 6.0 * UNIT * p0 * 2.0 * most
    return steepest * moved + (deepest(passage) + 1) * branch

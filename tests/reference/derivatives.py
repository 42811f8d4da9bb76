"""The Jacobian of an operator by a way of one's choice."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst import Operator, _engine

Array = NDArray[np.float64]

# Kinds of stages whose row has no derivative of its own.
WITHOUT_OWN = {
    "bouc_wen",
    "coleman_hodgdon",
    "creep",
    "creeping_plays",
    "dahl",
    "degrading_bouc_wen",
    "delay",
    "delay_preview",
    "generalized_maxwell_slip",
    "jiles_atherton",
    "lag",
    "lugre",
    "masing",
    "maxwell_slip",
    "memory_element",
    "rate_preview",
    "rate_shift",
    "state_map",
    "two_envelope",
}


def jacobian(operator: Operator, u: Array, derivative: str) -> Array:
    """By the stages' own derivatives where they have one ("auto"), or by the kernel alone."""
    chain = _engine.Chain(operator.stages())
    result = np.full((u.size, chain.parameter_count), np.nan)
    chain.jacobian(operator.initial_state(), u, result, derivative)
    return result


def off_their_bounds(operator: Operator) -> NDArray[np.bool_]:
    """Parameters that are not on their lower bound, as a threshold of 0.

    There the output has a kink that lasts: which side of it the kernel takes is decided by how its
    comparison treats a tie, not by where the parameter may go.
    """
    parameters = operator.parameters()
    return np.asarray(parameters.values > parameters.lower)

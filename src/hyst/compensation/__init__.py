"""Compensation: the input that makes a model follow a wanted output."""

from __future__ import annotations

from hyst.compensation.compensation import Compensation, error_parts
from hyst.compensation.inverse_error import ErrorBound, error_bound
from hyst.compensation.inverse_reduction import reduce_inverse
from hyst.compensation.inverse_slopes import slope_range
from hyst.compensation.trajectory_inversion import METHODS, invert_trajectory

__all__ = [
    "METHODS",
    "Compensation",
    "ErrorBound",
    "error_bound",
    "error_parts",
    "invert_trajectory",
    "reduce_inverse",
    "slope_range",
]


def __dir__() -> list[str]:
    return __all__

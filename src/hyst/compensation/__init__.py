"""Compensation: the input that makes a model follow a wanted output."""

from __future__ import annotations

from hyst.compensation.coded import CodedCommand, change_of_output, in_codes
from hyst.compensation.error_of_inverse.inverse_error import ErrorBound, error_bound
from hyst.compensation.error_of_inverse.inverse_reduction import reduce_inverse
from hyst.compensation.error_of_inverse.inverse_slopes import slope_range
from hyst.compensation.expectation import ModelError
from hyst.compensation.invert import METHODS, invert_trajectory
from hyst.compensation.learning.compensator import LearningCompensator
from hyst.compensation.learning.contraction import Contraction
from hyst.compensation.learning.repetition import Repetition
from hyst.compensation.loop_check.loops import LoopsBehind
from hyst.compensation.loop_check.loops_behind import loops_behind
from hyst.compensation.result import Compensation, error_parts
from hyst.compensation.suited_methods import methods_for

__all__ = [
    "METHODS",
    "CodedCommand",
    "Compensation",
    "Contraction",
    "ErrorBound",
    "LearningCompensator",
    "LoopsBehind",
    "ModelError",
    "Repetition",
    "change_of_output",
    "error_bound",
    "error_parts",
    "in_codes",
    "invert_trajectory",
    "loops_behind",
    "methods_for",
    "reduce_inverse",
    "slope_range",
]


def __dir__() -> list[str]:
    return __all__

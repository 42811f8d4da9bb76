"""Disturbance observers by H-infinity synthesis of a static gain."""

from __future__ import annotations

from hyst.control.disturbance_observer.certificate import Certificate
from hyst.control.disturbance_observer.design import (
    design_disturbance_observer,
    evaluate_gain,
    observer_problem,
)
from hyst.control.disturbance_observer.internal_model import InternalModel
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.result import DisturbanceObserver

__all__ = [
    "Certificate",
    "DisturbanceObserver",
    "InternalModel",
    "ObserverProblem",
    "design_disturbance_observer",
    "evaluate_gain",
    "observer_problem",
]


def __dir__() -> list[str]:
    return __all__

"""Robust control around a hysteresis: disturbance observer synthesis and closed-loop simulation."""

from __future__ import annotations

from hyst.control.closed_loop import ClosedLoop
from hyst.control.closed_loop_simulation import simulate_closed_loop
from hyst.control.discretization import discretize, discretized_dynamics
from hyst.control.disturbance_observer import (
    Certificate,
    DisturbanceObserver,
    InternalModel,
    ObserverProblem,
    design_disturbance_observer,
    evaluate_gain,
    observer_problem,
)
from hyst.control.frequency_responses import LoopResponses, loop_responses, uncertainty_used
from hyst.control.inexact_inverse import first_unstable_slope, slope_margin
from hyst.control.infinity_norm import hinf_norm
from hyst.control.inverse_comparison import EXACT, InverseComparison, compare_inverses
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.loop_system import closed_loop_poles
from hyst.control.q_filter import (
    DesignRow,
    QFilter,
    QFilterCertificate,
    QFilterObserver,
    RobustPerformance,
    compare_designs,
    design_q_filter,
    q_filter,
    robust_performance,
)
from hyst.control.tracking_controller import TrackingController

__all__ = [
    "EXACT",
    "Certificate",
    "ClosedLoop",
    "DesignRow",
    "DisturbanceObserver",
    "InternalModel",
    "InverseComparison",
    "LinearSystem",
    "LoopResponses",
    "ObserverProblem",
    "QFilter",
    "QFilterCertificate",
    "QFilterObserver",
    "RobustPerformance",
    "TrackingController",
    "as_linear_system",
    "closed_loop_poles",
    "compare_designs",
    "compare_inverses",
    "design_disturbance_observer",
    "design_q_filter",
    "discretize",
    "discretized_dynamics",
    "evaluate_gain",
    "first_unstable_slope",
    "hinf_norm",
    "loop_responses",
    "observer_problem",
    "q_filter",
    "robust_performance",
    "simulate_closed_loop",
    "slope_margin",
    "uncertainty_used",
]


def __dir__() -> list[str]:
    return __all__

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
from hyst.control.feedback.comparison import ComparedLoop, LoopComparison, compare_loops
from hyst.control.feedback.controller_design import design_controller
from hyst.control.feedback.designed_controller import ControllerDesign
from hyst.control.feedback.feedforward import reference_feedforward
from hyst.control.feedback.loop_plant import static_gain
from hyst.control.feedback.margins import LoopMargins, loop_margins
from hyst.control.frequency_responses import LoopResponses, loop_responses, uncertainty_used
from hyst.control.inexact_inverse import first_unstable_slope, slope_margin
from hyst.control.infinity_norm import hinf_norm
from hyst.control.inverse_comparison import EXACT, InverseComparison, compare_inverses
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.loop_poles import closed_loop_poles
from hyst.control.plants import (
    IdentifiedPlant,
    MeasuredPlant,
    has_dynamics_behind,
    identified_plant,
    measured_plant,
    plant_and_delay,
)
from hyst.control.python_control import closed_loop_system, to_nlsys
from hyst.control.q_filters import (
    DesignRow,
    QFilter,
    QFilterCertificate,
    QFilterObserver,
    RobustPerformance,
    SampledQFilterObserver,
    compare_blocks,
    compare_designs,
    design_q_filter,
    design_sampled_q_filter,
    q_filter,
    robust_performance,
)
from hyst.control.repetitive.certificate import RepetitiveCertificate
from hyst.control.repetitive.controller import RepetitiveController
from hyst.control.sampled.certificate import SampledCertificate, sampled_certificate
from hyst.control.sampled.folding import folded_uncertainty
from hyst.control.sampled.judged import LoopJudgement, judge_loop
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.control.sampled.responses import sampled_responses
from hyst.control.sampled.slopes import sampled_slope_failing, sampled_slope_proof
from hyst.control.sampled.stress import StressTest, stress
from hyst.control.sampled.tried import TriedLoop, try_block
from hyst.control.tracking_controller import TrackingController
from hyst.control.uncertainty import (
    UncertaintyWeight,
    identification_weight,
    require_no_less_than_known,
    uncertainty_weight,
)

__all__ = [
    "EXACT",
    "Certificate",
    "ClosedLoop",
    "ComparedLoop",
    "ControllerDesign",
    "DesignRow",
    "DisturbanceObserver",
    "IdentifiedPlant",
    "InternalModel",
    "InverseComparison",
    "LimitedDrive",
    "LimitedSchedule",
    "LinearSystem",
    "LoopComparison",
    "LoopJudgement",
    "LoopMargins",
    "LoopResponses",
    "MeasuredPlant",
    "ObserverProblem",
    "QFilter",
    "QFilterCertificate",
    "QFilterObserver",
    "RepetitiveCertificate",
    "RepetitiveController",
    "RobustPerformance",
    "SampledCertificate",
    "SampledPlant",
    "SampledQFilterObserver",
    "StressTest",
    "TrackingController",
    "TriedLoop",
    "UncertaintyWeight",
    "as_linear_system",
    "closed_loop_poles",
    "closed_loop_system",
    "compare_blocks",
    "compare_designs",
    "compare_inverses",
    "compare_loops",
    "design_controller",
    "design_disturbance_observer",
    "design_q_filter",
    "design_sampled_q_filter",
    "discretize",
    "discretized_dynamics",
    "evaluate_gain",
    "first_unstable_slope",
    "folded_uncertainty",
    "has_dynamics_behind",
    "hinf_norm",
    "identification_weight",
    "identified_plant",
    "judge_loop",
    "loop_margins",
    "loop_responses",
    "measured_plant",
    "observer_problem",
    "plant_and_delay",
    "q_filter",
    "reference_feedforward",
    "require_no_less_than_known",
    "robust_performance",
    "sampled_certificate",
    "sampled_plant",
    "sampled_responses",
    "sampled_slope_failing",
    "sampled_slope_proof",
    "simulate_closed_loop",
    "slope_margin",
    "static_gain",
    "stress",
    "to_nlsys",
    "try_block",
    "uncertainty_used",
    "uncertainty_weight",
]


def __dir__() -> list[str]:
    return __all__

"""Robust control around a hysteresis: disturbance observer synthesis and closed-loop simulation."""

from __future__ import annotations

from hyst.control.disturbance_observer import (
    Certificate,
    DisturbanceObserver,
    InternalModel,
    design_disturbance_observer,
    evaluate_gain,
)
from hyst.control.infinity_norm import hinf_norm
from hyst.control.linear_system import LinearSystem

__all__ = [
    "Certificate",
    "DisturbanceObserver",
    "InternalModel",
    "LinearSystem",
    "design_disturbance_observer",
    "evaluate_gain",
    "hinf_norm",
]

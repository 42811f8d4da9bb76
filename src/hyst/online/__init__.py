"""Estimation of hysteresis while it runs: radii, all constants, and the inverse with them."""

from __future__ import annotations

from hyst.online.adaptive_inverse import AdaptiveInverse
from hyst.online.excitation import Excitation, PlayExcitation
from hyst.online.innovation import Innovation
from hyst.online.joint_estimator import JointEstimator
from hyst.online.radius_estimator import RadiusEstimator
from hyst.online.trajectory import Trajectory

__all__ = [
    "AdaptiveInverse",
    "Excitation",
    "Innovation",
    "JointEstimator",
    "PlayExcitation",
    "RadiusEstimator",
    "Trajectory",
]


def __dir__() -> list[str]:
    return __all__

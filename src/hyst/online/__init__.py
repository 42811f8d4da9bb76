"""Estimation of hysteresis while it runs: radii, all constants, and the inverse with them."""

from __future__ import annotations

from hyst.online.adaptive_inverse import AdaptiveInverse
from hyst.online.estimator import Estimator
from hyst.online.joint.excitation import Excitation, PlayExcitation
from hyst.online.joint.innovation import Innovation
from hyst.online.joint.joint_estimator import JointEstimator
from hyst.online.joint.parts import units_of_plays
from hyst.online.knowledge import Knowledge
from hyst.online.radius_estimator import RadiusEstimator
from hyst.online.trajectory import Trajectory

__all__ = [
    "AdaptiveInverse",
    "Estimator",
    "Excitation",
    "Innovation",
    "JointEstimator",
    "Knowledge",
    "PlayExcitation",
    "RadiusEstimator",
    "Trajectory",
    "units_of_plays",
]


def __dir__() -> list[str]:
    return __all__

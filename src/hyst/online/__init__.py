"""Estimation of hysteresis while it runs: scale, radii, all constants, and the inverse."""

from __future__ import annotations

from hyst.online.adaptive_inverse import AdaptiveInverse
from hyst.online.choice import ESTIMATORS, estimator_for, name_of_estimator
from hyst.online.estimator import Estimator
from hyst.online.joint.excitation import Excitation, PlayExcitation
from hyst.online.joint.innovation import Innovation
from hyst.online.joint.joint_estimator import JointEstimator
from hyst.online.joint.parts import units_of_plays
from hyst.online.knowledge import Knowledge
from hyst.online.model.model_estimator import ModelEstimator
from hyst.online.radius.radius_estimator import RadiusEstimator
from hyst.online.radius.start import radius_estimator_for
from hyst.online.scale.scale_estimator import ScaleEstimator
from hyst.online.trajectory import Trajectory
from hyst.online.watch.asking import at_better_fit

__all__ = [
    "ESTIMATORS",
    "AdaptiveInverse",
    "Estimator",
    "Excitation",
    "Innovation",
    "JointEstimator",
    "Knowledge",
    "ModelEstimator",
    "PlayExcitation",
    "RadiusEstimator",
    "ScaleEstimator",
    "Trajectory",
    "at_better_fit",
    "estimator_for",
    "name_of_estimator",
    "radius_estimator_for",
    "units_of_plays",
]


def __dir__() -> list[str]:
    return __all__

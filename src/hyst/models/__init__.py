"""Models: named compositions and banks of operators."""

from __future__ import annotations

from hyst.models.generalized import GeneralizedPrandtlIshlinskii
from hyst.models.given_thresholds import GivenThresholds
from hyst.models.model_loading import load, load_described
from hyst.models.modified import ModifiedPrandtlIshlinskii
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.models.rate_curve import RateCurve
from hyst.models.rate_dependent import RateDependentPrandtlIshlinskii

__all__ = [
    "GeneralizedPrandtlIshlinskii",
    "GivenThresholds",
    "ModifiedPrandtlIshlinskii",
    "PrandtlIshlinskii",
    "RateCurve",
    "RateDependentPrandtlIshlinskii",
    "load",
    "load_described",
]

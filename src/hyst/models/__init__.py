"""Models: named compositions and banks of operators."""

from __future__ import annotations

from hyst.models.generalized import GeneralizedPrandtlIshlinskii
from hyst.models.model_loading import load, load_described
from hyst.models.modified import ModifiedPrandtlIshlinskii
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii

__all__ = [
    "GeneralizedPrandtlIshlinskii",
    "ModifiedPrandtlIshlinskii",
    "PrandtlIshlinskii",
    "load",
    "load_described",
]

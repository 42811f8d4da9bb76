"""Models: named compositions and banks of operators."""

from __future__ import annotations

from hyst.models.given_thresholds import GivenThresholds
from hyst.models.linear_dynamics import LinearDynamics
from hyst.models.loading_curve import InverseCurve
from hyst.models.mapped_prandtl_ishlinskii import (
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
)
from hyst.models.masing import MasingOperator
from hyst.models.memory_element import InverseMemoryElement, MemoryElement
from hyst.models.memory_function import MemoryFunction
from hyst.models.model_loading import load, load_described
from hyst.models.piecewise_linear import PiecewiseLinear
from hyst.models.polynomial_curve import PolynomialCurve
from hyst.models.power_law import PowerLaw
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.models.ramberg_osgood import RambergOsgood
from hyst.models.rate_curve import RateCurve
from hyst.models.rate_dependent import RateDependentPrandtlIshlinskii
from hyst.models.second_order_sections import SecondOrderSections
from hyst.models.stable_inverse import StableInverse

__all__ = [
    "GeneralizedPrandtlIshlinskii",
    "GivenThresholds",
    "InverseCurve",
    "InverseMemoryElement",
    "LinearDynamics",
    "MasingOperator",
    "MemoryElement",
    "MemoryFunction",
    "ModifiedPrandtlIshlinskii",
    "PiecewiseLinear",
    "PolynomialCurve",
    "PowerLaw",
    "PrandtlIshlinskii",
    "RambergOsgood",
    "RateCurve",
    "RateDependentPrandtlIshlinskii",
    "SecondOrderSections",
    "StableInverse",
    "load",
    "load_described",
]

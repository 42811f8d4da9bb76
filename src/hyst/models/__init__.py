"""Models: named compositions and banks of operators. A line makes a model known."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hyst.models.given_thresholds import GivenThresholds as GivenThresholds
from hyst.models.linear_dynamics import LinearDynamics as LinearDynamics
from hyst.models.loading_curve import InverseCurve as InverseCurve
from hyst.models.mapped_prandtl_ishlinskii import (
    GeneralizedPrandtlIshlinskii as GeneralizedPrandtlIshlinskii,
)
from hyst.models.mapped_prandtl_ishlinskii import (
    ModifiedPrandtlIshlinskii as ModifiedPrandtlIshlinskii,
)
from hyst.models.masing import MasingOperator as MasingOperator
from hyst.models.memory_element import InverseMemoryElement as InverseMemoryElement
from hyst.models.memory_element import MemoryElement as MemoryElement
from hyst.models.memory_function import MemoryFunction as MemoryFunction
from hyst.models.model_loading import load as load
from hyst.models.model_loading import load_described as load_described
from hyst.models.piecewise_linear import PiecewiseLinear as PiecewiseLinear
from hyst.models.polynomial_curve import PolynomialCurve as PolynomialCurve
from hyst.models.power_law import PowerLaw as PowerLaw
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii as PrandtlIshlinskii
from hyst.models.ramberg_osgood import RambergOsgood as RambergOsgood
from hyst.models.rate_curve import RateCurve as RateCurve
from hyst.models.rate_dependent import (
    RateDependentPrandtlIshlinskii as RateDependentPrandtlIshlinskii,
)
from hyst.models.second_order_sections import SecondOrderSections as SecondOrderSections
from hyst.models.stable_inverse import StableInverse as StableInverse

if not TYPE_CHECKING:  # a type checker goes by the lines above
    __all__ = [
        name
        for name, each in globals().items()
        if getattr(each, "__module__", "").startswith("hyst.models.")
    ]

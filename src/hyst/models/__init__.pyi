# The one list of models, for type checkers and for hyst/_lazy.py.

from hyst.models.bouc_wen import BoucWen as BoucWen
from hyst.models.butterfly import Butterfly as Butterfly
from hyst.models.coleman_hodgdon import ColemanHodgdon as ColemanHodgdon
from hyst.models.continuous_dynamics import ContinuousDynamics as ContinuousDynamics
from hyst.models.creep import Creep as Creep
from hyst.models.creeping_plays import CreepingPlays as CreepingPlays
from hyst.models.dahl import Dahl as Dahl
from hyst.models.degrading_bouc_wen import DegradingBoucWen as DegradingBoucWen
from hyst.models.delay import Delay as Delay
from hyst.models.dynamic_jiles_atherton import DynamicJilesAtherton as DynamicJilesAtherton
from hyst.models.exponential_curve import ExponentialCurve as ExponentialCurve
from hyst.models.generalized_maxwell_slip import (
    GeneralizedMaxwellSlip as GeneralizedMaxwellSlip,
)
from hyst.models.given_thresholds import GivenThresholds as GivenThresholds
from hyst.models.iwan import Iwan as Iwan
from hyst.models.iwan_curve import IwanCurve as IwanCurve
from hyst.models.jiles_atherton import JilesAtherton as JilesAtherton
from hyst.models.lag import Lag as Lag
from hyst.models.linear_dynamics import LinearDynamics as LinearDynamics
from hyst.models.loading_curve import InverseCurve as InverseCurve
from hyst.models.lugre import LuGre as LuGre
from hyst.models.mapped_prandtl_ishlinskii import (
    GeneralizedPrandtlIshlinskii as GeneralizedPrandtlIshlinskii,
)
from hyst.models.mapped_prandtl_ishlinskii import (
    ModifiedPrandtlIshlinskii as ModifiedPrandtlIshlinskii,
)
from hyst.models.masing import MasingOperator as MasingOperator
from hyst.models.maxwell_slip import MaxwellSlip as MaxwellSlip
from hyst.models.memory_element import InverseMemoryElement as InverseMemoryElement
from hyst.models.memory_element import MemoryElement as MemoryElement
from hyst.models.memory_function import MemoryFunction as MemoryFunction
from hyst.models.named_dynamics import low_pass as low_pass
from hyst.models.named_dynamics import resonance as resonance
from hyst.models.piecewise_linear import PiecewiseLinear as PiecewiseLinear
from hyst.models.polynomial_curve import PolynomialCurve as PolynomialCurve
from hyst.models.power_law import PowerLaw as PowerLaw
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii as PrandtlIshlinskii
from hyst.models.preisach import Preisach as Preisach
from hyst.models.ramberg_osgood import RambergOsgood as RambergOsgood
from hyst.models.rate_curve import RateCurve as RateCurve
from hyst.models.rate_dependent import (
    RateDependentPrandtlIshlinskii as RateDependentPrandtlIshlinskii,
)
from hyst.models.rate_preview import RateDependentPreview as RateDependentPreview
from hyst.models.rate_shift import RateShift as RateShift
from hyst.models.scheduled import Scheduled as Scheduled
from hyst.models.second_order_sections import SecondOrderSections as SecondOrderSections
from hyst.models.stable_inverse import StableInverse as StableInverse
from hyst.models.two_envelope import InverseTwoEnvelope as InverseTwoEnvelope
from hyst.models.two_envelope import (
    TwoEnvelopePrandtlIshlinskii as TwoEnvelopePrandtlIshlinskii,
)

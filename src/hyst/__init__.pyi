"""The names of hyst, a line each: what ``import hyst`` offers, and from where."""

from hyst import compensation as compensation
from hyst import control as control
from hyst import demo as demo
from hyst import errors as errors
from hyst import export as export
from hyst import files as files
from hyst import identification as identification
from hyst import io as io
from hyst import models as models
from hyst import online as online
from hyst import operators as operators
from hyst import report as report
from hyst import signals as signals
from hyst import studies as studies
from hyst.errors import HystError as HystError
from hyst.errors import InputError as InputError
from hyst.errors import MissingExtraError as MissingExtraError
from hyst.errors import NotIdentifiableError as NotIdentifiableError
from hyst.errors import NotInvertibleError as NotInvertibleError
from hyst.errors import SolverError as SolverError
from hyst.identification import Identified as Identified
from hyst.identification import identify as identify
from hyst.io import read_record as read_record
from hyst.models import GeneralizedPrandtlIshlinskii as GeneralizedPrandtlIshlinskii
from hyst.models import LinearDynamics as LinearDynamics
from hyst.models import MasingOperator as MasingOperator
from hyst.models import MemoryElement as MemoryElement
from hyst.models import ModifiedPrandtlIshlinskii as ModifiedPrandtlIshlinskii
from hyst.models import PrandtlIshlinskii as PrandtlIshlinskii
from hyst.models import RambergOsgood as RambergOsgood
from hyst.models import RateDependentPrandtlIshlinskii as RateDependentPrandtlIshlinskii
from hyst.models import load as load
from hyst.operators import Affine as Affine
from hyst.operators import Composition as Composition
from hyst.operators import DeadZone as DeadZone
from hyst.operators import Operator as Operator
from hyst.operators import Play as Play
from hyst.operators import Stop as Stop
from hyst.signals import Record as Record

__version__: str

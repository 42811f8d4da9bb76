# The one list of what hyst offers, for type checkers and for hyst/_lazy.py.
# A model is here once hyst/models/__init__.pyi names it.

from hyst import compensation as compensation
from hyst import control as control
from hyst import diagnosis as diagnosis
from hyst import export as export
from hyst import fleet as fleet
from hyst import identification as identification
from hyst import io as io
from hyst import jax as jax
from hyst import models as models
from hyst import online as online
from hyst import operators as operators
from hyst import report as report
from hyst import signals as signals
from hyst import sklearn as sklearn
from hyst import torch as torch
from hyst._loading import load as load
from hyst.diagnosis import Diagnosis as Diagnosis
from hyst.diagnosis import diagnose as diagnose
from hyst.errors import HystError as HystError
from hyst.errors import InputError as InputError
from hyst.errors import MissingExtraError as MissingExtraError
from hyst.errors import NotIdentifiableError as NotIdentifiableError
from hyst.errors import NotInvertibleError as NotInvertibleError
from hyst.errors import SolverError as SolverError
from hyst.identification import Comparison as Comparison
from hyst.identification import Identified as Identified
from hyst.identification import compare as compare
from hyst.identification import identify as identify
from hyst.identification.families.registry import families as families
from hyst.identification.fit_model import fit as fit
from hyst.identification.schedule.identified_schedule import (
    IdentifiedSchedule as IdentifiedSchedule,
)
from hyst.identification.schedule.identify_scheduled import (
    identify_scheduled as identify_scheduled,
)
from hyst.io import open_record as open_record
from hyst.io import read_frequency_response as read_frequency_response
from hyst.io import read_record as read_record
from hyst.models import *
from hyst.operators import Affine as Affine
from hyst.operators import Composition as Composition
from hyst.operators import DeadZone as DeadZone
from hyst.operators import Driver as Driver
from hyst.operators import ModelDescription as ModelDescription
from hyst.operators import Operator as Operator
from hyst.operators import Play as Play
from hyst.operators import Stop as Stop
from hyst.operators.batches import batch_loss_gradient as batch_loss_gradient
from hyst.operators.batches import evaluate_batch as evaluate_batch
from hyst.signals import Record as Record

__version__: str

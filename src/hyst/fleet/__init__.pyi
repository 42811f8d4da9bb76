# The one list of what fleets offer, for type checkers and for hyst/_lazy.py.

from hyst.fleet.fleet import Fleet as Fleet
from hyst.fleet.identify_fleet import identify as identify
from hyst.fleet.limits import as_limits as as_limits
from hyst.fleet.limits import parse_limit as parse_limit
from hyst.fleet.outliers import Outlier as Outlier
from hyst.fleet.shape_of_fleet import shape_of_folder as shape_of_folder
from hyst.fleet.shared_shape.device_result import SharedIdentified as SharedIdentified
from hyst.fleet.shared_shape.shared_shape import SharedShape as SharedShape
from hyst.fleet.sources import MeasurementSource as MeasurementSource
from hyst.fleet.table import FleetTable as FleetTable

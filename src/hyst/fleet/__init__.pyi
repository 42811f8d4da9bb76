# The one list of names of fleet, for type checkers and for hyst/_lazy.py.

from hyst.fleet.shared_shape.device_result import SharedIdentified as SharedIdentified
from hyst.fleet.shared_shape.shared_shape import SharedShape as SharedShape

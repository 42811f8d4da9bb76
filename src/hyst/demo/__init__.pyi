# The one list of what the demonstration offers, for type checkers and for hyst/_lazy.py.

from hyst.demo.simulated_fleet import SimulatedDevice as SimulatedDevice
from hyst.demo.simulated_fleet import simulated_fleet as simulated_fleet
from hyst.demo.simulated_fleet import write_simulated_fleet as write_simulated_fleet
from hyst.demo.stage import SimulatedStage as SimulatedStage
from hyst.demo.story import BANNER as BANNER
from hyst.demo.story import Story as Story
from hyst.demo.story import Tracking as Tracking
from hyst.demo.story import tell as tell

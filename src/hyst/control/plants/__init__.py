"""Plants for a design: from an identification, and as users write them."""

from __future__ import annotations

from hyst.control.plants.dead_time import plant_and_delay
from hyst.control.plants.identified import IdentifiedPlant, identified_plant
from hyst.control.plants.measured import MeasuredPlant, measured_plant
from hyst.control.plants.parts import has_dynamics_behind

__all__ = [
    "IdentifiedPlant",
    "MeasuredPlant",
    "has_dynamics_behind",
    "identified_plant",
    "measured_plant",
    "plant_and_delay",
]


def __dir__() -> list[str]:
    return __all__

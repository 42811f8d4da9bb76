"""Plants for a design: from an identification, and as users write them."""

from __future__ import annotations

from hyst.control.plants.identified_plant import IdentifiedPlant, identified_plant
from hyst.control.plants.parts import has_dynamics_behind
from hyst.control.plants.plant_and_delay import plant_and_delay

__all__ = ["IdentifiedPlant", "has_dynamics_behind", "identified_plant", "plant_and_delay"]

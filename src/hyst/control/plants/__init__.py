"""Plants for a design: from an identification, and as users write them."""

from __future__ import annotations

from hyst.control.plants.identified_plant import IdentifiedPlant, identified_plant
from hyst.control.plants.plant_and_delay import plant_and_delay

__all__ = ["IdentifiedPlant", "identified_plant", "plant_and_delay"]

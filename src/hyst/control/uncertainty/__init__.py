"""How far a plant may be from the nominal one: weights from measurements and identification."""

from __future__ import annotations

from hyst.control.uncertainty.weight import UncertaintyWeight, uncertainty_weight

__all__ = ["UncertaintyWeight", "uncertainty_weight"]

"""How far a plant may be from the nominal one: weights from measurements and identification."""

from __future__ import annotations

from hyst.control.uncertainty.from_identification import (
    identification_weight,
    require_no_less_than_known,
)
from hyst.control.uncertainty.weight import UncertaintyWeight, uncertainty_weight

__all__ = [
    "UncertaintyWeight",
    "identification_weight",
    "require_no_less_than_known",
    "uncertainty_weight",
]


def __dir__() -> list[str]:
    return __all__

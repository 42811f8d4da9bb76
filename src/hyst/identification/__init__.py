"""Identification: from records to models that can be inverted."""

from __future__ import annotations

from hyst.identification import hammerstein
from hyst.identification.from_records import identify
from hyst.identification.identified import Candidate, Identified, UsedSamples
from hyst.identification.slopes import Slopes, identify_weights_from_slopes

__all__ = [
    "Candidate",
    "Identified",
    "Slopes",
    "UsedSamples",
    "hammerstein",
    "identify",
    "identify_weights_from_slopes",
]


def __dir__() -> list[str]:
    return __all__

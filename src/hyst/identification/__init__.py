"""Identification: from records to models that can be inverted."""

from __future__ import annotations

from hyst.identification.from_records import identify
from hyst.identification.identified import Candidate, Identified, UsedSamples

__all__ = ["Candidate", "Identified", "UsedSamples", "identify"]

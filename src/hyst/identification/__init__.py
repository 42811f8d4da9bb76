"""Identification: from records to models."""

from __future__ import annotations

from hyst.identification.identified import Candidate, Identified, UsedSamples

__all__ = ["Candidate", "Identified", "UsedSamples"]

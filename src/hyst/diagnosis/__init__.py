"""Diagnosis: what records can tell, and what they cannot, before any model."""

from __future__ import annotations

from hyst.diagnosis.diagnose_records import Diagnosis, diagnose
from hyst.diagnosis.finding import Finding

__all__ = ["Diagnosis", "Finding", "diagnose"]


def __dir__() -> list[str]:
    return __all__

"""Delay between input and output: what the records show of it."""

from __future__ import annotations

import math

from hyst.diagnosis.delay_evidence import DelayEvidence, evidence_of_delay
from hyst.identification.record_use.used_samples import Data


def find_delay(data: Data) -> DelayEvidence:
    """Ask the records for their delay; the delay they already have is ignored.

    Parameters
    ----------
    data
        The records.
    """
    bare = data.delayed(0.0)
    return evidence_of_delay(bare.records, bare.starts, bare.kept)


def usable_delay(evidence: DelayEvidence, data: Data) -> float:
    """Give the delay, cut where it would leave less than half of a record.

    Parameters
    ----------
    evidence
        Of the records.
    data
        The records.
    """
    half = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True)) // 2
    delay = max(-half, min(evidence.delay, half))
    return math.trunc(delay) if float(delay).is_integer() else delay

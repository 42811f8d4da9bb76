"""Delay between input and output: what the records show, in whole samples."""

from __future__ import annotations

from hyst.diagnosis.delay_evidence import DelayEvidence, evidence_of_delay
from hyst.identification.record_use.used_samples import Data


def find_delay(data: Data) -> DelayEvidence:
    """Ask the records for their delay; the delay they already have is ignored.

    Parameters
    ----------
    data
        The records.
    """
    return evidence_of_delay(data.records, data.starts)


def whole_delay(evidence: DelayEvidence, data: Data) -> int:
    """Give the delay in whole samples, at least 0, that leaves half of every record.

    Parameters
    ----------
    evidence
        Of the records.
    data
        The records.
    """
    half = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True)) // 2
    return max(0, min(round(evidence.delay), half))

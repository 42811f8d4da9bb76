"""The delay of records under diagnosis, found once for all findings that concern it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hyst.diagnosis.delay_evidence import DelayEvidence, evidence_of_delay
from hyst.diagnosis.evidence import Evidence
from hyst.signals import Record

_COVERED = 0.95
"""Of the range of a record's input: from then on the memory of what is looked for is known."""


def delay_of(evidence: Evidence) -> DelayEvidence | None:
    """Give the evidence on the delay common to all records in which something moves."""
    return evidence.once("delay", lambda: _delay_of(evidence))


def settled_starts(records: Sequence[Record]) -> list[int]:
    """Give the first sample of each record at which its memory is known; 0 where that is late."""
    starts = []
    for each in records:
        covered = np.maximum.accumulate(each.u) - np.minimum.accumulate(each.u)
        first = int((covered >= _COVERED * float(np.ptp(each.u))).argmax())
        starts.append(first if first <= len(each) / 2 else 0)
    return starts


def _delay_of(evidence: Evidence) -> DelayEvidence | None:
    records, kept = [], []
    for number, record in evidence.numbered():
        drift = evidence.drift(number)
        records.append(record if drift is None else replace(record, y=record.y - drift.curve))
        counts = np.ones(record.samples, dtype=np.bool_)
        counts[evidence.left_out(number)] = False
        kept.append(None if counts.all() else counts)
    return evidence_of_delay(records, settled_starts(records), kept) if records else None

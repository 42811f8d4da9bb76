"""A drift of the output, with its size."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hyst.diagnosis.drift import Drift
from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.findings import step_change
from hyst.diagnosis.wording import amount, of_record, percent
from hyst.signals import Record

NAME = "drift"
# Of the range: below the first it harms nobody, from the second on it harms everybody.
_LEAST, _MUCH = 5e-4, 3e-3


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn of a drift beyond the noise, where the memory returns to the same state."""
    for number, record in evidence.numbered():
        drift = evidence.drift(number)
        if drift is None or not drift.shown or evidence.named(step_change.NAME, number):
            continue
        span = float(np.ptp(record.y))
        noise = evidence.noise(number) or 0.0
        size = abs(drift.total)
        if size < _LEAST * span or (size < _MUCH * span and size < noise):
            continue
        yield Finding(
            NAME,
            "warning",
            _sentence(record, drift, span, of_record(evidence, number)),
            "Models here do not drift: it stays in what a fit leaves, and pulls at its constants. "
            "Let the actuator warm up or settle, or take the drift out of the record first.",
            record=number,
            amounts={
                "rate": drift.rate,
                "rate error": drift.rate_error,
                "total": drift.total,
                "early": drift.early,
                "late": drift.late,
            },
        )


def _sentence(record: Record, drift: Drift, span: float, where: str) -> str:
    unit = record.output_unit
    shape = ""
    if not drift.straight:
        shape = (
            f"; it is not even, {amount(drift.early, unit, 's')} early and "
            f"{amount(drift.late, unit, 's')} late, as creep and warming up are"
        )
    return (
        f"{where}the output drifts by {amount(drift.rate, unit, 's')} "
        f"(+- {amount(drift.rate_error, '')}), {amount(drift.total, unit)} over the record or "
        f"{percent(abs(drift.total) / span)} of its range{shape}."
    )

"""Records as an identification takes them: without what is no measurement, and without drift."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis
from hyst.diagnosis.findings.drifting_output import NAME as DRIFT
from hyst.diagnosis.findings.foreign_lines import NAME as FOREIGN_LINE
from hyst.diagnosis.findings.output_is_noise import NAME as OUTPUT_IS_NOISE
from hyst.diagnosis.findings.still_signals import NAME as STILL_SIGNAL
from hyst.diagnosis.slow_drift import slow_drift
from hyst.errors import HystError, InputError, NotIdentifiableError
from hyst.identification.record_use.foreign_sines import foreign_sines
from hyst.identification.record_use.one_sample_time import marked_at_one_time
from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record

Array = NDArray[np.float64]

REFUSED_AS: dict[str, type[HystError]] = {
    STILL_SIGNAL: NotIdentifiableError,
    OUTPUT_IS_NOISE: NotIdentifiableError,
}
"""By name of the finding: records that are read right and show nothing; else they are faulty."""


@dataclass(frozen=True, eq=False)
class Cleaned:
    """Records to fit to, and what was taken from them.

    Parameters
    ----------
    records
        Samples that are no measurements are filled in from their neighbours, for what knows of no
        gaps, and slow drift and sines that are none of the drive are taken out.
    kept
        Shape (N,) for each record: which output samples count; None for all.
    disturbances
        Shape (N,) for each record: what was taken out; None where there was nothing.
    drifts
        Shape (N,) for each record: the slow drift among it; empty where there is none.
    """

    records: tuple[Record, ...]
    kept: tuple[NDArray[np.bool_] | None, ...]
    disturbances: tuple[Array | None, ...]
    drifts: tuple[Array | None, ...] = ()

    def with_drift(self) -> Cleaned:
        """Give the records with their slow drift left in; ``drifts`` still tells it."""
        drifts = self.drifts or (None,) * len(self.records)
        back = [None if each is None else -each for each in drifts]
        records, disturbances = [], []
        for record, taken, more in zip(self.records, self.disturbances, back, strict=True):
            rest = taken if more is None or taken is None else taken + more
            nothing = rest is None or not rest.any()
            disturbances.append(None if nothing else rest)
            records.append(record if more is None else replace(record, y=record.y - more))
        return replace(self, records=tuple(records), disturbances=tuple(disturbances))

    def without(self, parts: Sequence[Array]) -> Cleaned:
        """Give the records without some part of each, which becomes a disturbance.

        Parameters
        ----------
        parts
            Shape (N,) for each record, output units.
        """
        records, disturbances = [], []
        for record, taken, part in zip(self.records, self.disturbances, parts, strict=True):
            records.append(replace(record, y=record.y - part))
            disturbances.append(part if taken is None else taken + part)
        return replace(self, records=tuple(records), disturbances=tuple(disturbances))

    def marked(self, data: Data) -> Data:
        """Give data made of these records with what was taken from them.

        Parameters
        ----------
        data
            Made of the records; of averages of them nothing more can be said.
        """
        same = len(data.records) == len(self.records) and all(
            len(a) == len(b) for a, b in zip(data.records, self.records, strict=True)
        )
        if not same:
            return marked_at_one_time(data, self.records, self.kept)
        kept = self.kept if any(each is not None for each in self.kept) else ()
        disturbances = (
            self.disturbances if any(each is not None for each in self.disturbances) else ()
        )
        return replace(data, kept=kept, disturbances=disturbances)


def as_drift(drift: Any) -> Literal["auto", False]:
    """Check what is to be done about drift.

    Parameters
    ----------
    drift
        ``"auto"`` or ``False``.

    Raises
    ------
    InputError
        If it is something else.
    """
    if drift is False or (isinstance(drift, str) and drift == "auto"):
        return "auto" if drift else False
    raise InputError(
        f"drift is {drift!r}; give 'auto' to take slow drift out, or False to leave it"
    )


def cleaned(
    records: Sequence[Record], diagnosis: Diagnosis, drift: Literal["auto", False]
) -> Cleaned:
    """Act on what a diagnosis found.

    Parameters
    ----------
    records
        As they were given.
    diagnosis
        Of these records.
    drift
        ``"auto"`` takes out slow drift and foreign sines where the records show them.

    Raises
    ------
    InputError
        If a finding says that the records as they are hold something else than measurements.
    NotIdentifiableError
        If one says that a signal is constant, or an output noise.
    """
    for finding in diagnosis.of("refusal"):
        where = f"record {finding.record}: " if len(records) > 1 and finding.record else ""
        error = REFUSED_AS.get(finding.name, InputError)
        raise error(f"{where}{finding.sentence} {finding.advice}".strip())
    taken = [_cleaned(r, i, diagnosis, drift) for i, r in enumerate(records, 1)]
    kept, given, disturbances, drifts = zip(*taken, strict=True)
    return Cleaned(given, kept, disturbances, drifts)


def _cleaned(
    record: Record, number: int, diagnosis: Diagnosis, drift: Literal["auto", False]
) -> tuple[NDArray[np.bool_] | None, Record, Array | None, Array | None]:
    kept = None
    left_out = diagnosis.left_out(number)
    if left_out.size:
        kept = np.ones(len(record), dtype=np.bool_)
        kept[left_out] = False
        places = np.flatnonzero(kept)
        record = replace(record, y=np.interp(np.arange(len(record)), places, record.y[places]))
    if drift != "auto":
        return kept, record, None, None
    disturbance, slow = _disturbance(record, number, diagnosis)
    if disturbance is None:
        return kept, record, None, None
    return kept, replace(record, y=record.y - disturbance), disturbance, slow


def _disturbance(
    record: Record, number: int, diagnosis: Diagnosis
) -> tuple[Array | None, Array | None]:
    """Give drift and sines together that a diagnosis found in an output, and the drift alone."""
    parts = []
    if any(each.record in (number, 0) for each in diagnosis.named(DRIFT)):
        found = slow_drift(record)
        if found is not None:
            parts.append(found.curve)
    slow = parts[0] if parts else None
    lines = [e.amounts["frequency"] for e in diagnosis.named(FOREIGN_LINE) if e.record == number]
    if lines:
        rest = replace(record, y=record.y - parts[0]) if parts else record
        parts.append(foreign_sines(rest, lines))
    return (np.sum(parts, axis=0), slow) if parts else (None, None)

"""Records as an identification takes them: without what is no measurement, and without drift."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis
from hyst.diagnosis.slow_drift import slow_drift
from hyst.errors import InputError
from hyst.identification.record_use.used_samples import Data
from hyst.signals import Record

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Cleaned:
    """Records to fit to, and what was taken from them.

    Parameters
    ----------
    records
        Samples that are no measurements are filled in from their neighbours, for what knows of no
        gaps, and slow drift is taken out.
    kept
        Shape (N,) for each record: which output samples count; None for all.
    drifts
        Shape (N,) for each record: what was taken out; None where there was nothing.
    """

    records: tuple[Record, ...]
    kept: tuple[NDArray[np.bool_] | None, ...]
    drifts: tuple[Array | None, ...]

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
            return data
        kept = self.kept if any(each is not None for each in self.kept) else ()
        drifts = self.drifts if any(each is not None for each in self.drifts) else ()
        return replace(data, kept=kept, drifts=drifts)


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
        ``"auto"`` takes out slow drift where the records show it.

    Raises
    ------
    InputError
        If a finding says that nothing can be identified from the records as they are.
    """
    for finding in diagnosis.of("refusal"):
        where = f"record {finding.record}: " if len(records) > 1 and finding.record else ""
        raise InputError(f"{where}{finding.sentence} {finding.advice}".strip())
    taken = [_cleaned(r, diagnosis.left_out(i), drift) for i, r in enumerate(records, 1)]
    kept, given, drifts = zip(*taken, strict=True)
    return Cleaned(given, kept, drifts)


def _cleaned(
    record: Record, left_out: NDArray[np.intp], drift: Literal["auto", False]
) -> tuple[NDArray[np.bool_] | None, Record, Array | None]:
    kept = None
    if left_out.size:
        kept = np.ones(len(record), dtype=np.bool_)
        kept[left_out] = False
        places = np.flatnonzero(kept)
        record = replace(record, y=np.interp(np.arange(len(record)), places, record.y[places]))
    found = slow_drift(record) if drift == "auto" else None
    if found is None:
        return kept, record, None
    return kept, replace(record, y=record.y - found.curve), found.curve

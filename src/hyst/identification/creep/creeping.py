"""A search with what was found of creep, and what it says of the motion of the output."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis
from hyst.identification.creep.creeping_family import CreepingFamily
from hyst.identification.creep.evidence import Evidence
from hyst.identification.creep.told import (
    DriftBeside,
    drift_beside,
    is_known,
    notes_on,
    sentence_without,
)
from hyst.identification.fit.nuisance import Drift, Nuisances, moments_of, over_whole_records
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import Identified
from hyst.identification.result.motion import BEFORE, DRIFT, motion_of
from hyst.identification.search import Found
from hyst.signals import Record

Array = NDArray[np.float64]

CLEARLY = 0.9
"""Share of the error that a model of a rarer kind must leave to be preferred to creep."""


@dataclass(frozen=True, eq=False)
class Creeping:
    """A search whose fit creeps, or what it says of creep where it does not.

    Parameters
    ----------
    found
        With the creep, or as it was.
    evidence
        What was seen of creep, where it was looked for and not taken.
    drifts
        What drifts beside creep; empty where there is no creep.
    beside
        By name, over the samples in use: what was fitted beside creep, or taken out as drift.
    asked
        Whether the user asked for creep.
    """

    found: Found
    evidence: Evidence | None = None
    drifts: tuple[DriftBeside, ...] = ()
    beside: Mapping[str, Array] = field(default_factory=dict)
    asked: bool = False

    @property
    def creeps(self) -> bool:
        """Whether the model has creep."""
        return isinstance(self.found.fit.family, CreepingFamily)

    def leaves_noise(self) -> bool:
        """Tell whether what the model leaves is noise."""
        return self.found.leaves_noise

    def or_better(self, other: Creeping) -> Creeping:
        """Give this search if it found creep, unless another one leaves clearly less.

        Parameters
        ----------
        other
            Made among more families.
        """
        if not self.creeps or other._misses() < CLEARLY * self._misses():
            return other
        return self

    def _misses(self) -> float:
        data = self.found.data
        return float(np.std(data.measured() - model_output(data, self.found.fit.operator)))

    def judged(self, diagnosis: Diagnosis, records: Sequence[Record]) -> Diagnosis:
        """Give a diagnosis that knows of the creep.

        Parameters
        ----------
        diagnosis
            Made before.
        records
            As they were given.
        """
        return drift_beside(diagnosis, records, self.drifts) if self.creeps else diagnosis

    def told(self, identified: Identified) -> Identified:
        """Give a result that tells of creep, drift and what else moves the output.

        Parameters
        ----------
        identified
            As every fit gives it.
        """
        data, notes = self.found.data, identified.undetermined
        if self.creeps:
            notes += notes_on(identified, data)
        elif self.evidence is not None and (self.asked or self.beside):
            notes += (sentence_without(self.evidence),)
        elif not self.beside:
            return identified  # nobody asked, and nothing came up
        known = self.evidence is not None and is_known(self.evidence)
        motion = motion_of(
            data, self.found.fit.operator, self.beside, identified.bands.noise, known
        )
        return replace(identified, undetermined=notes, motion=motion)


def by_name(
    data: Data,
    nuisances: Nuisances,
    theta: Array,
    coefficients: Sequence[Array],
    scale: float,
) -> dict[str, list[Array]]:
    """Give what each kind of column makes at every output sample of each record.

    Parameters
    ----------
    data
        The records.
    nuisances, theta, coefficients
        The columns, and what each record has of them.
    scale
        What to multiply by.
    """
    found, first = dict[str, list[Array]](), 0
    for part in nuisances.parts:
        count = part.count(moments_of(data)[0], theta)
        own = [each[first : first + count] for each in coefficients]
        name = DRIFT if isinstance(part, Drift) else BEFORE
        parts = over_whole_records(data, Nuisances((part,)), theta, own)
        found[name] = [scale * each for each in parts]
        first += count
    return found


def over_windows(data: Data, signals: Sequence[Array]) -> Array:
    """Give signals of whole records over the samples in use.

    Parameters
    ----------
    data
        The records.
    signals
        Of each, shape (N,).
    """
    pairs = zip(data.records, signals, strict=True)
    return replace(data, records=tuple(replace(each, y=y) for each, y in pairs)).measured()


def taken_out(data: Data, records: Cleaned) -> dict[str, Array]:
    """Give the slow drift that was taken out before a fit, over the samples in use.

    Parameters
    ----------
    data
        The records of the fit.
    records
        With what was taken out of them.
    """
    same = len(data.records) == len(records.drifts) and all(
        each is None or each.size == len(record)
        for each, record in zip(records.drifts, data.records, strict=True)
    )
    if not same or all(each is None for each in records.drifts):
        return {}
    pairs = zip(data.records, records.drifts, strict=True)
    parts = [np.zeros(len(record)) if each is None else each for record, each in pairs]
    return {DRIFT: over_windows(data, parts)}

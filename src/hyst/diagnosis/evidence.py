"""Records under diagnosis, and what is found out about them once for all findings."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.drift import Drift, drift_of
from hyst.diagnosis.finding import NO_SAMPLES, Finding
from hyst.diagnosis.loops import Loop, loops_of
from hyst.diagnosis.repetition import Repetition, noise_of, repetition_of
from hyst.signals import Record

Found = TypeVar("Found")


@dataclass(frozen=True, eq=False)
class Evidence:
    """The records, and a store for what several findings need.

    Parameters
    ----------
    records
        One or more, all of one actuator as their user believes.
    """

    records: tuple[Record, ...]
    _found: dict[Hashable, object] = field(default_factory=dict, init=False, repr=False)
    _told: list[Finding] = field(default_factory=list, init=False, repr=False)

    def once(self, key: Hashable, find: Callable[[], Found]) -> Found:
        """Give what ``find`` finds, and find it only the first time this key is asked for."""
        if key not in self._found:
            self._found[key] = find()
        return self._found[key]  # type: ignore[return-value]

    def tell(self, findings: Iterable[Finding]) -> None:
        """Take note of what was found, for the findings that are looked for later."""
        self._told.extend(findings)

    def named(self, name: str, record: int) -> tuple[Finding, ...]:
        """Give what was found so far of that name in that record, counted from 1."""
        return tuple(each for each in self._told if each.name == name and each.record == record)

    def left_out(self, number: int) -> NDArray[np.intp]:
        """Give the samples of a record, counted from 1, that were found to be no measurements."""
        parts = [
            each.samples
            for each in self._told
            if each.severity == "left out" and each.record == number
        ]
        return np.unique(np.concatenate([NO_SAMPLES, *parts]))

    def usable(self, number: int) -> Record:
        """Give a record with straight lines over the samples that are no measurements."""
        left_out = self.left_out(number)
        return self.once(
            ("usable", number, left_out.tobytes()),
            lambda: _bridged(self.records[number - 1], left_out),
        )

    def numbered(self) -> Iterator[tuple[int, Record]]:
        """Give the usable records in which something moves, with their numbers."""
        for number in range(1, len(self.records) + 1):
            record = self.usable(number)
            if record.samples >= 4 and np.ptp(record.u) > 0.0 and np.ptp(record.y) > 0.0:
                yield number, record

    def repetition(self, number: int) -> Repetition | None:
        """Give where a record repeats itself."""
        record = self.usable(number)
        return self.once(("repetition", id(record)), lambda: repetition_of(record.u))

    def noise(self, number: int) -> float | None:
        """Give the noise of an output by repetition; None where nothing repeats."""
        found, record = self.repetition(number), self.usable(number)
        if found is None:
            return None
        return self.once(("noise", id(record)), lambda: noise_of(found, record))

    def drift(self, number: int) -> Drift | None:
        """Give the drift of an output; None where too little repeats."""
        found, record = self.repetition(number), self.usable(number)
        if found is None:
            return None
        return self.once(("drift", id(record)), lambda: drift_of(found, record))

    def loops(self, number: int) -> tuple[Loop, ...]:
        """Give the loops of a record, drift taken out where there is one."""
        record, drift = self.usable(number), self.drift(number)
        rate = drift.rate if drift is not None and drift.shown else 0.0
        return self.once(("loops", id(record)), lambda: loops_of(record, rate))


def _bridged(record: Record, left_out: NDArray[np.intp]) -> Record:
    kept = np.ones(record.samples, dtype=bool)
    kept[left_out[left_out < record.samples]] = False
    if kept.all() or not kept.any():
        return record
    at, known = np.flatnonzero(~kept), np.flatnonzero(kept)
    u, y = record.u.copy(), record.y.copy()
    for signal in (u, y):
        signal[at] = np.interp(at, known, signal[known])
    return replace(record, u=u, y=y)

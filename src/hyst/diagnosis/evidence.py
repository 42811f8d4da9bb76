"""Records under diagnosis, and what is found out about them once for all findings."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.finding import NO_SAMPLES, Finding
from hyst.diagnosis.loops import Loop, loops_of
from hyst.diagnosis.repetition import Repetition, noise_of, repetition_of
from hyst.diagnosis.slow_drift import Drift, slow_drift
from hyst.signals import Record, estimate_noise

Found = TypeVar("Found")

# Ranges beyond these are no measurements, and their squares leave the numbers there are.
_SMALLEST, _LARGEST = 1e-100, 1e100


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
            if self._refused(number):
                continue
            record = self.usable(number)
            spans = (float(np.ptp(record.u)), float(np.ptp(record.y)))
            if record.samples >= 4 and all(_SMALLEST < span < _LARGEST for span in spans):
                yield number, record

    def _refused(self, number: int) -> bool:
        return any(e.severity == "refusal" and e.record in (0, number) for e in self._told)

    def repetition(self, number: int) -> Repetition | None:
        """Give where a record repeats itself."""
        record = self.usable(number)
        return self.once(("repetition", id(record)), lambda: repetition_of(record.u))

    def noise(self, number: int) -> float | None:
        """Give the noise of an output by repetition; None where nothing repeats."""
        found, record = self.repetition(number), self.usable(number)
        if found is None:
            return None
        return self.once(
            ("noise", id(record)), lambda: noise_of(found, record, self.left_out(number))
        )

    def noise_or_guess(self, number: int) -> float:
        """Give the noise by repetition, or by how rough the output is, which may be too much."""
        noise, record = self.noise(number), self.usable(number)
        if noise is not None:
            return noise
        return self.once(("guess", id(record)), lambda: estimate_noise(record.y))

    def drift(self, number: int) -> Drift | None:
        """Give the drift of an output; None where too little repeats, or nothing drifts."""
        found, record = self.repetition(number), self.usable(number)
        if found is None:
            return None
        return self.once(("drift", id(record)), lambda: slow_drift(record, found))

    def loops(self, number: int) -> tuple[Loop, ...]:
        """Give the loops of a record, drift taken out where there is one."""
        record, drift = self.usable(number), self.drift(number)
        rate = drift.rate if drift is not None else 0.0
        return self.once(("loops", id(record)), lambda: loops_of(record, rate))


def _bridged(record: Record, left_out: NDArray[np.intp]) -> Record:
    kept = np.ones(record.samples, dtype=bool)
    kept[left_out[left_out < record.samples]] = False
    if kept.all() or not kept.any():
        return record
    at, known = np.flatnonzero(~kept), np.flatnonzero(kept)
    y = record.y.copy()
    y[at] = np.interp(at, known, y[known])  # what is left out is never of the input
    return replace(record, y=y)

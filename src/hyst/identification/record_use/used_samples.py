"""The records of an identification, with the samples of each that can be used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.errors import InputError, NotIdentifiableError
from hyst.signals import Record, reversals, units_differ

Array = NDArray[np.float64]

# Plays up to this share of half the input range are looked for: beyond, a play hardly moves.
LARGEST_RADIUS = 0.95


@dataclass(frozen=True)
class UsedSamples:
    """Which samples of a record took part.

    Parameters
    ----------
    start
        First output sample used; before it the memory of the actuator is not known, because the
        input has not yet passed its whole range.
    stop
        One past the last.
    total
        Samples of the record.
    """

    start: int
    stop: int
    total: int


@dataclass(frozen=True, eq=False)
class Data:
    """Records and the window of each: model output k is compared with y[k + delay].

    Parameters
    ----------
    records
        One or more, all with the same sample time.
    starts
        First model sample used, for each record.
    delay
        Whole samples by which y lags.
    half_range
        Half the range of all inputs, input units.
    settled
        Whether the memory is known at every start because the input has passed its range before.
    """

    records: tuple[Record, ...]
    starts: tuple[int, ...]
    delay: int
    half_range: float
    settled: bool

    @property
    def largest_radius(self) -> float:
        """Largest radius these records can determine, input units."""
        return LARGEST_RADIUS * self.half_range

    def windows(self) -> list[slice]:
        """Give the model samples used, one slice for each record."""
        return [
            slice(start, len(record) - self.delay)
            for start, record in zip(self.starts, self.records, strict=True)
        ]

    def measured(self) -> Array:
        """Give the outputs to be explained, all records one after the other."""
        return np.concatenate(
            [
                record.y[start + self.delay :]
                for start, record in zip(self.starts, self.records, strict=True)
            ]
        )

    def used(self) -> tuple[UsedSamples, ...]:
        """Tell which output samples take part."""
        return tuple(
            UsedSamples(start + self.delay, len(record), len(record))
            for start, record in zip(self.starts, self.records, strict=True)
        )

    def delayed(self, delay: int) -> Data:
        """Give the same records with another delay."""
        return replace(self, delay=delay)

    def lengths(self) -> list[int]:
        """Give the number of samples used of each record."""
        return [window.stop - window.start for window in self.windows()]

    def in_units(self, input_scale: float, output_scale: float) -> Data:
        """Give the same records in smaller units, in which their numbers are larger.

        Parameters
        ----------
        input_scale, output_scale
            By which the numbers of input and output grow.
        """
        records = tuple(
            replace(each, u=each.u * input_scale, y=each.y * output_scale) for each in self.records
        )
        return replace(self, records=records, half_range=self.half_range * input_scale)


def prepare(
    records: Record | Sequence[Record],
    start: Literal["auto"] | int,
    delay: int,
    fewest_turns: int = 1,
) -> Data:
    """Check the records and decide which samples can be used.

    With ``start="auto"`` a record is used from where its input has passed ``LARGEST_RADIUS`` of the
    whole range: from there on the memory of every play looked for is known, whatever was before. If
    that leaves less than half of the records, all samples are used and no memory is assumed before
    the first one.

    Parameters
    ----------
    records
        One or more records.
    start
        ``"auto"`` or the first sample to use.
    delay
        Whole samples by which the output lags.
    fewest_turns
        How often every input must turn: one rise and fall shows both branches of a loop.

    Returns
    -------
    Data

    Raises
    ------
    InputError
        If there is no record, their sample times differ, or ``start`` is no sample of every record.
    NotIdentifiableError
        If input or output of a record is constant, or the input does not turn often enough.
    """
    given = (records,) if isinstance(records, Record) else tuple(records)
    _check(given, fewest_turns)
    low = min(float(record.u.min()) for record in given)
    high = max(float(record.u.max()) for record in given)
    half_range = (high - low) / 2.0
    if start == "auto":
        starts = tuple(_first_settled(r.u, 2.0 * LARGEST_RADIUS * half_range) for r in given)
        kept = sum(len(r) - s for r, s in zip(given, starts, strict=True))
        settled = kept >= sum(len(r) for r in given) / 2.0
        starts = starts if settled else (0,) * len(given)
    else:
        starts, settled = (_as_start(start, given),) * len(given), True
    return Data(given, starts, delay, half_range, settled)


def require_same_units(records: Sequence[Record]) -> None:
    """Refuse records whose signals are in different units; an empty unit agrees with every other.

    Parameters
    ----------
    records
        All that will be compared with one model.

    Raises
    ------
    InputError
        If an input or output has another unit than that of an earlier record.
    """
    for signal in ("input", "output"):
        known = ""
        for number, record in enumerate(records, 1):
            unit = getattr(record, f"{signal}_unit", "")  # what is no record is refused later
            if units_differ(unit, known):
                raise InputError(
                    f"the {signal} of record {number} (training first, then validation) is in "
                    f"{unit!r}, of an earlier one in {known!r}; hyst converts no units, so bring "
                    "them to one"
                )
            known = known or unit


def _check(records: tuple[Record, ...], fewest_turns: int) -> None:
    if not records:
        raise InputError("there is no record; give at least one")
    for number, record in enumerate(records, 1):
        if not isinstance(record, Record):
            raise InputError(f"record {number} is {type(record).__name__}; give a hyst.Record")
        if not np.isclose(record.dt, records[0].dt, rtol=1e-6, atol=0.0):
            raise InputError(
                f"record {number} has dt = {record.dt:.6g} s, the first one {records[0].dt:.6g} s; "
                "the delay is counted in samples, so give records of one sample time"
            )
        if np.ptp(record.u) == 0.0:
            raise NotIdentifiableError(
                f"the input of record {number} is constant ({record.u[0]:.6g}); drive the actuator"
            )
        if np.ptp(record.y) == 0.0:
            raise NotIdentifiableError(
                f"the output of record {number} is constant ({record.y[0]:.6g}); check the sensor"
            )
        turns = reversals(record.u, 0.05 * float(np.ptp(record.u))).size
        if turns < fewest_turns:
            raise NotIdentifiableError(
                f"the input of record {number} turns {turns} times; hysteresis shows only after "
                "it has turned, so record a rise and a fall"
            )


def _first_settled(u: Array, span: float) -> int:
    """First sample at which the input has covered ``span``; its length if it never does."""
    covered = np.maximum.accumulate(u) - np.minimum.accumulate(u) >= span
    return int(covered.argmax()) if covered.any() else u.size


def _as_start(start: int, records: tuple[Record, ...]) -> int:
    shortest = min(len(record) for record in records)
    return whole_number(start, "start", 0, shortest - 1, ", or 'auto'")

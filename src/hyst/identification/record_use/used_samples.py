"""The records of an identification, with the samples of each that can be used."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.record_use.part_of_a_sample import by_whole_samples, lag_in_samples, later
from hyst.identification.record_use.smoothed_drive import Smoother
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
    left_out
        How many between start and stop do not count because they are no measurements.
    """

    start: int
    stop: int
    total: int
    left_out: int = 0


@dataclass(frozen=True, eq=False)
class Data:
    """Records and the window of each: model output k is compared with y at k + lag.

    Parameters
    ----------
    records
        One or more. The input of each comes later than measured by the part of a sample that its
        lag has beyond whole ones, so that model and output meet at whole samples.
    starts
        First model sample used, for each record.
    lag
        Samples of the first record by which y lags; records of another sample time lag by the same
        time. Negative where the output is ahead of the input.
    half_range
        Half the range of all inputs, input units.
    settled
        Whether the memory is known at every start because the input has passed its range before.
    kept
        Shape (N,) for each record: which output samples count; None for all.
    disturbances
        Shape (N,) for each record: slow drift and foreign sines that were taken out of its y; None
        where there were none.
    measured_inputs
        The inputs as they were measured, where those of ``records`` are later by part of a sample.
    smoothers
        For each record what took the noise out of its input; None where nothing did.
    keeps_corners
        Whether an input that is later by part of a sample keeps its corners, as memory needs them;
        not where rates matter.
    past
        Shape (N,) for each record: what a past that nobody knows left in its y, taken out of it;
        empty where nothing was.
    level
        What was taken out of every y, output units, for the fit alone.
    """

    records: tuple[Record, ...]
    starts: tuple[int, ...]
    lag: float
    half_range: float
    settled: bool
    kept: tuple[NDArray[np.bool_] | None, ...] = ()
    disturbances: tuple[Array | None, ...] = ()
    measured_inputs: tuple[Array, ...] = ()
    smoothers: tuple[Smoother | None, ...] = ()
    keeps_corners: bool = True
    past: tuple[Array, ...] = ()
    level: float = 0.0

    @property
    def largest_radius(self) -> float:
        """Largest radius these records can determine, input units."""
        return LARGEST_RADIUS * self.half_range

    @property
    def delay(self) -> int:
        """Whole samples by which y lags the input of the first record as it stands here."""
        return self.whole_lags()[0]

    def lag_of(self, number: int) -> float:
        """Give the lag in samples of one record, counted from 0."""
        return lag_in_samples(self.lag, self.records[0].dt, self.records[number].dt)

    def whole_lags(self) -> list[int]:
        """Give for each record how many samples its y comes after its input as it stands here."""
        return [math.floor(self.lag_of(i)) for i in range(len(self.records))]

    def windows(self) -> list[slice]:
        """Give the model samples over which outputs are compared, one slice for each record."""
        return [
            slice(max(start, -late), len(record) - max(late, 0))
            for start, record, late in zip(
                self.starts, self.records, self.whole_lags(), strict=True
            )
        ]

    def outputs(self) -> list[Array]:
        """Give y at the model samples of every window, those left out filled in."""
        return [
            record.y[window.start + late : window.stop + late]
            for record, window, late in zip(
                self.records, self.windows(), self.whole_lags(), strict=True
            )
        ]

    def brought_forward(self) -> list[Array]:
        """Give y at every model sample up to the end of its window; before it begins, its first."""
        return [
            np.concatenate([np.full(max(-late, 0), record.y[0]), record.y])[
                max(late, 0) : max(late, 0) + window.stop
            ]
            for record, window, late in zip(
                self.records, self.windows(), self.whole_lags(), strict=True
            )
        ]

    def counted(self) -> list[NDArray[np.bool_] | None]:
        """Give which model samples of every window count; None for all."""
        if not self.kept:
            return [None] * len(self.records)
        return [
            None if kept is None else kept[window.start + late : window.stop + late]
            for kept, window, late in zip(self.kept, self.windows(), self.whole_lags(), strict=True)
        ]

    def joined(self, over_windows: Sequence[Array]) -> Array:
        """Put what there is for every sample of the windows into one array, if the sample counts.

        Parameters
        ----------
        over_windows
            For each record, shape (samples of its window, ...).
        """
        parts = [
            part if counts is None else part[counts]
            for part, counts in zip(over_windows, self.counted(), strict=True)
        ]
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def inputs(self) -> Array:
        """Give the inputs of the samples that count, all records one after the other."""
        windows = zip(self.records, self.windows(), strict=True)
        return self.joined([record.u[window] for record, window in windows])

    def measured(self) -> Array:
        """Give the outputs to be explained, all records one after the other."""
        return self.joined(self.outputs())

    def used(self) -> tuple[UsedSamples, ...]:
        """Tell which output samples take part."""
        return tuple(
            UsedSamples(
                window.start + late,
                window.stop + late,
                len(record),
                0 if counts is None else int(np.count_nonzero(~counts)),
            )
            for record, window, late, counts in zip(
                self.records, self.windows(), self.whole_lags(), self.counted(), strict=True
            )
        )

    def delayed(self, lag: float) -> Data:
        """Give the same records with another lag."""
        inputs = self.measured_inputs or tuple(record.u for record in self.records)
        late = [lag_in_samples(lag, self.records[0].dt, record.dt) for record in self.records]
        parts = [each - math.floor(each) for each in late]
        records = tuple(
            record if record.u is u and not part else replace(record, u=self._later(u, part))
            for record, u, part in zip(self.records, inputs, parts, strict=True)
        )
        return replace(self, records=records, lag=lag, measured_inputs=inputs if any(parts) else ())

    def a_little_later(self, more: float) -> Data:
        """Give the same windows with inputs that come later by a little, at the same lag.

        Parameters
        ----------
        more
            Samples of the first record, less than one; negative for earlier.
        """
        inputs = self.measured_inputs or tuple(record.u for record in self.records)
        records = []
        for number, (record, u) in enumerate(zip(self.records, inputs, strict=True)):
            own = self.lag_of(number)
            moved = own - math.floor(own) + lag_in_samples(more, self.records[0].dt, record.dt)
            whole = math.floor(moved)
            # An earlier input goes on after its last sample, on the line through the last two.
            further = u[-1] + np.array([1.0, 2.0]) * np.diff(u[-2:]).sum()
            beyond = self._later(np.concatenate([u, further]), moved - whole)
            shifted = by_whole_samples(beyond, whole)
            records.append(replace(record, u=shifted[: u.size]))
        return replace(self, records=tuple(records))

    def _later(self, u: Array, part: float) -> Array:
        return later(u, part, self.keeps_corners)

    def lengths(self) -> list[int]:
        """Give the number of samples of each record that count."""
        return [
            window.stop - window.start if counts is None else int(np.count_nonzero(counts))
            for window, counts in zip(self.windows(), self.counted(), strict=True)
        ]

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
        return replace(
            self,
            records=records,
            half_range=self.half_range * input_scale,
            disturbances=tuple(
                None if each is None else each * output_scale for each in self.disturbances
            ),
            measured_inputs=tuple(u * input_scale for u in self.measured_inputs),
            level=self.level * output_scale,
            smoothers=tuple(
                None if each is None else replace(each, noise=each.noise * input_scale)
                for each in self.smoothers
            ),
            past=tuple(each * output_scale for each in self.past),
        )

    def with_past(self) -> Data:
        """Give the records as measured, with what the past left in them."""
        pairs = zip(self.records, self.past, strict=True) if self.past else ()
        records = tuple(replace(each, y=each.y + part) for each, part in pairs)
        return replace(self, records=records, past=()) if records else self

    def with_disturbances(self) -> Data:
        """Give the records with the drift and the sines that were taken out."""
        if not self.disturbances:
            return self
        records = tuple(
            record if drift is None else replace(record, y=record.y + drift)
            for record, drift in zip(self.records, self.disturbances, strict=True)
        )
        return replace(self, records=records, disturbances=())


def prepare(
    records: Record | Sequence[Record],
    start: Literal["auto"] | int,
    lag: float = 0.0,
    fewest_turns: int = 1,
) -> Data:
    """Check the records and decide which samples can be used.

    With ``start="auto"`` a record is used from where its input has passed ``LARGEST_RADIUS`` of its
    own range: from there on the memory of every play that moves in it is known, whatever was
    before. Wider plays, which a record of larger amplitude may show, stand still in it. If that
    leaves less than half of the records, all samples are used and no memory is assumed before the
    first one.

    Parameters
    ----------
    records
        One or more records.
    start
        ``"auto"`` or the first sample to use.
    lag
        Samples of the first record by which the output lags.
    fewest_turns
        How often every input must turn: one rise and fall shows both branches of a loop.

    Returns
    -------
    Data

    Raises
    ------
    InputError
        If there is no record, or ``start`` is no sample of every record.
    NotIdentifiableError
        If input or output of a record is constant, or the input does not turn often enough.
    """
    given = (records,) if isinstance(records, Record) else tuple(records)
    _check(given, fewest_turns)
    low = min(float(record.u.min()) for record in given)
    high = max(float(record.u.max()) for record in given)
    half_range = (high - low) / 2.0
    if start == "auto":
        starts = tuple(_first_settled(r.u, LARGEST_RADIUS * float(np.ptp(r.u))) for r in given)
        kept = sum(len(r) - s for r, s in zip(given, starts, strict=True))
        settled = kept >= sum(len(r) for r in given) / 2.0
        starts = starts if settled else (0,) * len(given)
    else:
        starts, settled = (_as_start(start, given),) * len(given), True
    return Data(given, starts, 0.0, half_range, settled).delayed(lag)


def beside_level(records: Sequence[Record], data: Data) -> list[Record]:
    """Give records without what was taken out of the y of others.

    Parameters
    ----------
    records
        As they were measured.
    data
        The others.
    """
    if not data.level:
        return list(records)
    return [replace(each, y=each.y - data.level) for each in records]


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

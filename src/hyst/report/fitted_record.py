"""A record beside the model's output, cut to the samples that took part."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification import Identified, UsedSamples, late_output
from hyst.operators import Affine
from hyst.signals import Record

Array = NDArray[np.float64]


MOST_BANDED = 50_000
"""Samples of a record for which the band is worked out: nobody sees it in longer ones."""


@dataclass(frozen=True, eq=False)
class FittedRecord:
    """A record and a model's output for it.

    Parameters
    ----------
    label
        What figures call the record.
    record
        The record.
    y_model
        Model's output for all samples, delayed as the measured one is, shape (N,).
    start
        First sample that takes part; before it the memory of the actuator is not known.
    stop
        One past the last; where the output is ahead of the input, its end has no input.
    delay
        Samples by which the output lags.
    band
        Lowest and highest output of the band of 95 %, each of shape (N,); None for long records.
    """

    label: str
    record: Record
    y_model: Array
    start: int
    stop: int
    delay: float
    band: tuple[Array, Array] | None = None

    @property
    def time(self) -> Array:
        """Time of the samples that take part, s."""
        return self.record.time[self.start : self.stop]

    @property
    def measured(self) -> Array:
        """Measured output that takes part."""
        return self.record.y[self.start : self.stop]

    @property
    def modelled(self) -> Array:
        """Modelled output that takes part."""
        return self.y_model[self.start : self.stop]

    @property
    def error(self) -> Array:
        """Modelled minus measured output, output units."""
        return self.modelled - self.measured

    @property
    def model_input(self) -> Array:
        """The input each of these outputs belongs to, ``delay`` samples earlier."""
        return late_output(Affine(1.0), self.record.u, self.delay)[self.start : self.stop]


def fit_records(
    identified: Identified, training: tuple[Record, ...], validation: tuple[Record, ...]
) -> tuple[tuple[FittedRecord, ...], tuple[FittedRecord, ...]]:
    """Run the model over all records.

    Parameters
    ----------
    identified
        The result.
    training
        Records it was identified from.
    validation
        Records kept apart.

    Returns
    -------
    training, validation : tuple of FittedRecord
    """
    return (
        tuple(
            _fit(identified, record, used, _label("training", number, len(training)))
            for number, (record, used) in enumerate(
                zip(training, identified.used_of_shown, strict=True), 1
            )
        ),
        fit_other_records(identified, validation),
    )


def fit_other_records(
    identified: Identified, records: tuple[Record, ...]
) -> tuple[FittedRecord, ...]:
    """Run the model over records that took no part.

    Parameters
    ----------
    identified
        The result.
    records
        In its units.
    """
    return tuple(
        _fit(
            identified,
            record,
            _all_that_have_an_input(record, identified.delay),
            _label("validation", number, len(records)),
        )
        for number, record in enumerate(records, 1)
    )


def _fit(identified: Identified, record: Record, used: UsedSamples, label: str) -> FittedRecord:
    y_model = identified.predict(record.u, record.dt)
    band = identified.band(record.u, dt=record.dt) if len(record) <= MOST_BANDED else None
    delay = identified.delay * (identified.description.dt or record.dt) / record.dt
    return FittedRecord(label, record, y_model, used.start, used.stop, delay, band)


def _all_that_have_an_input(record: Record, delay: float) -> UsedSamples:
    total = len(record)
    return UsedSamples(max(math.ceil(delay), 0), total + min(math.floor(delay), 0), total)


def _label(role: str, number: int, count: int) -> str:
    return role if count == 1 else f"{role} {number}"

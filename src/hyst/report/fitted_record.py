"""A record beside the model's output, cut to the samples that took part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification import Identified
from hyst.signals import Record

Array = NDArray[np.float64]


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
    delay
        Whole samples by which the output lags.
    """

    label: str
    record: Record
    y_model: Array
    start: int
    delay: int

    @property
    def time(self) -> Array:
        """Time of the samples that take part, s."""
        return self.record.time[self.start :]

    @property
    def measured(self) -> Array:
        """Measured output that takes part."""
        return self.record.y[self.start :]

    @property
    def modelled(self) -> Array:
        """Modelled output that takes part."""
        return self.y_model[self.start :]

    @property
    def error(self) -> Array:
        """Modelled minus measured output, output units."""
        return self.modelled - self.measured

    @property
    def model_input(self) -> Array:
        """The input each of these outputs belongs to, ``delay`` samples earlier."""
        indices = np.arange(self.start, len(self.record)) - self.delay
        return self.record.u[np.maximum(indices, 0)]


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
            _fit(identified, record, used.start, _label("training", number, len(training)))
            for number, (record, used) in enumerate(zip(training, identified.used, strict=True), 1)
        ),
        tuple(
            _fit(
                identified, record, identified.delay, _label("validation", number, len(validation))
            )
            for number, record in enumerate(validation, 1)
        ),
    )


def _fit(identified: Identified, record: Record, start: int, label: str) -> FittedRecord:
    delay = identified.delay
    return FittedRecord(label, record, identified.predict(record.u), start, delay)


def _label(role: str, number: int, count: int) -> str:
    return role if count == 1 else f"{role} {number}"

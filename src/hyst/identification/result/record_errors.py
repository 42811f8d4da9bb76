"""How good a model is for each of several records."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Operator
from hyst.signals import Metrics, error_metrics

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RecordErrors:
    """Errors of a model over one of the records it was identified from.

    Parameters
    ----------
    number
        Of the record, counted from 1.
    samples
        How many of its samples were used.
    metrics
        Errors over those, in percent of this record's own output range; None if none was used, or
        the output does not move over them.
    name
        Of the record, as its file's; empty if it is not known.
    """

    number: int
    samples: int
    metrics: Metrics | None
    name: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Give everything as plain numbers and text."""
        metrics = None if self.metrics is None else self.metrics.to_dict()
        return {
            "record": self.number,
            "name": self.name,
            "used_samples": self.samples,
            "metrics": metrics,
        }


def errors_by_record(data: Data, operator: Operator) -> tuple[RecordErrors, ...]:
    """Give the errors of a model over each of its records.

    Parameters
    ----------
    data
        The records of the fit.
    operator
        The model.

    Returns
    -------
    tuple of RecordErrors
        In the order of the records.
    """
    lengths = data.lengths()
    ends = np.cumsum(lengths)[:-1]
    measured = np.split(data.measured(), ends)
    modelled = np.split(model_output(data, operator), ends)
    return tuple(
        RecordErrors(number, lengths[number - 1], _errors(y, y_model, float(np.ptp(record.y))))
        for number, (record, y, y_model) in enumerate(
            zip(data.records, measured, modelled, strict=True), 1
        )
    )


def _errors(y: Array, y_model: Array, output_range: float) -> Metrics | None:
    if y.size == 0 or y.min() == y.max():
        return None
    return error_metrics(y, y_model, output_range=output_range)

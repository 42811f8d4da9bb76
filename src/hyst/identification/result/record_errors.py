"""How good a model is for each of several records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Operator
from hyst.signals import Metrics, error_metrics, hysteresis_percent, reversals

Array = NDArray[np.float64]

SEVERAL_RATES = 1.2
"""Times the frequency of the slowest record, from which rates are different ones."""

SMALLEST_TURN = 0.05
"""Of the input's range: smaller turns are no branches."""


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
    frequency
        Mean frequency of the whole drive, Hz; None if it turns less than twice.
    hysteresis, modelled_hysteresis
        Widest opening of the loop in percent of the output's range over those, measured and of the
        model; noise widens the measured one. None if the drive does not turn.
    """

    number: int
    samples: int
    metrics: Metrics | None
    name: str = ""
    frequency: float | None = None
    hysteresis: float | None = None
    modelled_hysteresis: float | None = None

    def to_dict(self) -> dict[str, Any]:
        """Give everything as plain numbers and text."""
        metrics = None if self.metrics is None else self.metrics.to_dict()
        return {
            "record": self.number,
            "name": self.name,
            "used_samples": self.samples,
            "metrics": metrics,
            "frequency": self.frequency,
            "hysteresis_percent": self.hysteresis,
            "modelled_hysteresis_percent": self.modelled_hysteresis,
        }


def run_at_several_rates(errors: Sequence[RecordErrors]) -> bool:
    """Tell whether records were driven at frequencies far enough apart to be told.

    Parameters
    ----------
    errors
        Of each record.
    """
    known = [each.frequency for each in errors if each.frequency is not None]
    return len(known) > 1 and max(known) > SEVERAL_RATES * min(known)


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
    inputs = np.split(data.inputs(), ends)
    return tuple(
        RecordErrors(
            number,
            lengths[number - 1],
            _errors(y, y_model, float(np.ptp(record.y))),
            frequency=_frequency(record.u, record.dt),
            hysteresis=_hysteresis(u, y),
            modelled_hysteresis=_hysteresis(u, y_model),
        )
        for number, (record, u, y, y_model) in enumerate(
            zip(data.records, inputs, measured, modelled, strict=True), 1
        )
    )


def _errors(y: Array, y_model: Array, output_range: float) -> Metrics | None:
    if y.size == 0 or y.min() == y.max():
        return None
    return error_metrics(y, y_model, output_range=output_range)


def _frequency(u: Array, dt: float) -> float | None:
    turns = reversals(u, SMALLEST_TURN * float(np.ptp(u))) if u.size else np.empty(0)
    if turns.size < 2:
        return None
    return float((turns.size - 1) / (2.0 * (turns[-1] - turns[0]) * dt))


def _hysteresis(u: Array, y: Array) -> float | None:
    try:
        return hysteresis_percent(u, y, SMALLEST_TURN * float(np.ptp(u)))
    except (InputError, ValueError):  # nothing turns or moves
        return None


def record_line(each: RecordErrors, unit: str, several_rates: bool) -> str:
    """Say how far a model is from one record, ``each``, in its ``unit``, and its loop's size.

    The latter where the records have ``several_rates``.
    """
    named = f"record {each.number}" + (f", {each.name}" if each.name else "")
    if each.metrics is None:
        return f"{named:28s} no sample that moves was used"
    return (
        f"{named:28s} rms {each.metrics.rms:.4g}{unit} ({each.metrics.rms_percent:.3f} % of its "
        f"own range)   max {each.metrics.max_abs:.4g}{unit}   {each.samples} samples"
        f"{_loop_in_words(each) if several_rates else ''}"
    )


def _loop_in_words(each: RecordErrors) -> str:
    if each.frequency is None or each.hysteresis is None or each.modelled_hysteresis is None:
        return ""
    return (
        f"   at {each.frequency:.4g} Hz: hysteresis {each.hysteresis:.3g} %, of the model "
        f"{each.modelled_hysteresis:.3g} %"
    )

"""A model over a second signal at values that took no part: how straight its lines are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.part_of_a_sample import lag_in_samples
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.identification.result.identified import Identified
from hyst.identification.schedule.identified_schedule import Checked
from hyst.identification.schedule.values_of_records import AtValue
from hyst.models import Scheduled
from hyst.operators import Operator
from hyst.signals import error_metrics


def left_out_of(
    model: Scheduled, data: Sequence[Data], results: Sequence[Identified]
) -> tuple[Checked, ...]:
    """Judge the straight lines by every inner value: what the others say of it.

    Parameters
    ----------
    model
        The model.
    data, results
        The records at each value, and what was identified from them.
    """
    checked = []
    for i in range(1, len(data) - 1):
        rest = [k for k in range(len(data)) if k != i]
        others = Scheduled([model.models[k] for k in rest], model.values[rest], model.name)
        value, noise = float(model.values[i]), results[i].metrics["training"].rms
        ends = float(model.values[i - 1]), float(model.values[i + 1])
        checked.append(_checked(others.at(value), data[i], value, noise, ends))
    return tuple(checked)


def held_out_of(
    model: Scheduled,
    group: AtValue,
    results: Sequence[Identified],
    first: Data,
    start: int | Literal["auto"],
) -> Checked:
    """Judge a model at a value of records that took no part.

    Parameters
    ----------
    model, results
        As of ``left_out_of``.
    group
        The records.
    first
        Those of the first value, for the delay.
    start
        First sample to use.
    """
    lag = lag_in_samples(first.lag, first.records[0].dt, group.records[0].dt)
    data = prepare(group.records, start, lag)
    values, value = model.values, group.value
    high = min(max(int(np.searchsorted(values, value)), 1), values.size - 1)
    noise = max(results[k].metrics["training"].rms for k in (high - 1, high))
    outside = bool(model.outside(value))
    ends = (values[0], values[-1]) if outside else (values[high - 1], values[high])
    between = (float(ends[0]), float(ends[1]))
    return replace(_checked(model.at(value), data, value, noise, between), outside=outside)


def _checked(
    operator: Operator, data: Data, value: float, noise: float, between: tuple[float, float]
) -> Checked:
    measured = data.measured()
    span = max(r.y.max() for r in data.records) - min(r.y.min() for r in data.records)
    errors = error_metrics(measured, model_output(data, operator), output_range=float(span))
    return Checked(value, errors.rms, errors.rms_percent, noise, between)

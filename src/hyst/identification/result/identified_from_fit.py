"""From a fit to the result: standard errors, what is not determined, metrics, description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis
from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.identification.families.family import Fit
from hyst.identification.fit.problem import model_output
from hyst.identification.judgement.judge import judge
from hyst.identification.record_use.part_of_a_sample import lag_in_samples
from hyst.identification.record_use.smoothed_drive import driven_by, without_noise
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.identification.result.bands import bands_of
from hyst.identification.result.fit_spread import spread_of_fit
from hyst.identification.result.identified import Candidate, Identified
from hyst.identification.result.record_errors import errors_by_record
from hyst.operators import ModelDescription, Operator
from hyst.operators.description import errors_of
from hyst.operators.provenance import provenance
from hyst.signals import Metrics, Record, error_metrics
from hyst.signals.turning_points import swings_of

Array = NDArray[np.float64]


def identified_from_fit(
    data: Data,
    fit: Fit,
    candidates: tuple[Candidate, ...],
    validation: Sequence[Record],
    notes: tuple[str, ...],
    diagnosis: Diagnosis,
    rivals: Sequence[Operator] = (),
    delay: DelayEvidence | None = None,
) -> Identified:
    """Put the result of an identification together.

    Parameters
    ----------
    data
        The records.
    fit
        The final fit, in their units.
    candidates
        What was compared.
    validation
        Records that took no part.
    notes
        Sentences about what was left out before the fit.
    diagnosis
        What the records showed before any model.
    rivals
        Models of other kinds that fit the records equally well.
    delay
        What the records say of their delay; None where it was given, or is part of the model.

    Returns
    -------
    Identified
    """
    operator, estimates = fit.operator, fit.family.estimates(fit)
    errors, not_told_apart = np.full(len(estimates.names), np.nan), tuple[str, ...]()
    spread = spread_of_fit(data, fit, delay)
    if fit.family.estimates_noise:
        errors = spread.of(estimates.by_theta)
        not_told_apart = spread.not_told_apart(estimates)
    metrics = metrics_by_record(data, operator, validation)
    return Identified(
        model=operator,
        family=fit.family.name,
        delay=data.lag,
        parameter_names=estimates.names,
        parameter_values=estimates.values,
        standard_errors=errors,
        undetermined=notes + fit.family.notes(fit, data) + not_told_apart,
        metrics=metrics,
        candidates=candidates,
        status=fit.solution.status,
        iterations=fit.solution.iterations,
        used=data.used(),
        description=describe(data, fit.family.name),
        verdict=judge(data, fit, diagnosis, metrics),
        delay_interval=(data.lag, data.lag) if delay is None else delay.stated,
        diagnosis=diagnosis,
        bands=bands_of(data, fit, spread, rivals),
        per_record=errors_by_record(data, operator),
        motion=(),
    )


def traced(found: Identified, records: Sequence[Record], options: Mapping[str, Any]) -> Identified:
    """Give a result whose model tells what it means, how far it is to be trusted, and its origin.

    It keeps the records, unless it has others already: what its family made of them.

    Parameters
    ----------
    found
        As identified, with the description of its signals.
    records
        What it was identified from.
    options
        What was asked for otherwise than by default.

    Returns
    -------
    Identified
    """
    about = replace(
        found.description,
        delay=found.delay,
        delay_interval=found.delay_interval,
        verdict=found.verdict,
        errors=errors_of(found.metrics),
        provenance=provenance(records, options),
    )
    return replace(
        found,
        description=about,
        model=found.model.with_description(about),
        records=found.records or tuple(records),
    )


def metrics_by_record(
    data: Data, operator: Operator, validation: Sequence[Record]
) -> dict[str, Metrics]:
    """Give the errors of a model over its own and other records.

    Parameters
    ----------
    data
        The records of the fit.
    operator
        The model.
    validation
        Records that took no part.

    Returns
    -------
    dict
        By name: ``training``, ``validation 1``, ..., each with and without a free offset.
    """
    metrics = _pair("training", data, operator)
    if data.disturbances:
        metrics |= _pair("training, disturbances left in", data.with_disturbances(), operator)
    for number, record in enumerate(validation, 1):
        name = "validation" if len(validation) == 1 else f"validation {number}"
        metrics |= _pair(name, _validation_data(record, data), operator)
    return metrics


def _validation_data(record: Record, data: Data) -> Data:
    """Prepare a record that takes no part: it lags as the others, and its drive is as smooth."""
    smoother = next((each for each in data.smoothers if each is not None), None)
    if smoother is not None:
        record = driven_by(record, without_noise(record, smoother.time_constant))
    lag = lag_in_samples(data.lag, data.records[0].dt, record.dt)
    own = replace(prepare(record, "auto"), keeps_corners=data.keeps_corners)
    return own.delayed(lag)


def _pair(name: str, data: Data, operator: Operator) -> dict[str, Metrics]:
    """Errors with and without a free offset, in percent of the whole records' output range."""
    measured, modelled = data.measured(), model_output(data, operator)
    if data.past:
        # Shares of the output are of what was measured; what the past left is in both, so no error.
        data = data.with_past()
        modelled = modelled + (data.measured() - measured)
        measured = data.measured()
    span = max(r.y.max() for r in data.records) - min(r.y.min() for r in data.records)
    return {
        name: error_metrics(measured, modelled, output_range=float(span)),
        f"{name}, free offset": error_metrics(
            measured, modelled, free_offset=True, output_range=float(span)
        ),
    }


def describe(data: Data, family: str) -> ModelDescription:
    """Give names, units and ranges of the records for the model file.

    Parameters
    ----------
    data
        The records of the fit.
    family
        The family of the model.

    Returns
    -------
    ModelDescription
    """
    first, outputs = data.records[0], data.with_past().measured()
    return ModelDescription(
        input_name=first.input_name,
        output_name=first.output_name,
        input_unit=first.input_unit,
        output_unit=first.output_unit,
        input_low=float(min(r.u.min() for r in data.records)),
        input_high=float(max(r.u.max() for r in data.records)),
        output_low=float(outputs.min()),
        output_high=float(outputs.max()),
        dt=first.dt,
        delay=data.lag,
        family=family,
        smallest_swing=_smallest_swing(data.records),
    )


def _smallest_swing(records: Sequence[Record]) -> float | None:
    """Give the least way of the inputs between two turns; None if none has two."""
    extent = max(r.u.max() for r in records) - min(r.u.min() for r in records)
    swings = [swings_of(record.u, float(extent)) for record in records]
    return min((float(each.min()) for each in swings if each.size), default=None)

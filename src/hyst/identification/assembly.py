"""From a fit to the result: standard errors, what is not determined, metrics, description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.identification.covariance import robust_covariance, undetermined_combination
from hyst.identification.data import Data, prepare
from hyst.identification.families import RAMBERG_OSGOOD, Parametrization, at_limit_of_power
from hyst.identification.fitting import Fit, Fitter, model_jacobian, model_output
from hyst.identification.identified import Candidate, Identified
from hyst.operators import ModelDescription, Operator
from hyst.operators.description import errors_of
from hyst.operators.provenance import provenance
from hyst.signals import Metrics, Record, error_metrics

Array = NDArray[np.float64]


def assemble(
    fitter: Fitter,
    fit: Fit,
    plays_wanted: int,
    candidates: tuple[Candidate, ...],
    validation: Sequence[Record],
    left_out: tuple[str, ...],
) -> Identified:
    """Put the result of an identification together.

    Parameters
    ----------
    fitter, fit
        The records and the final fit.
    plays_wanted
        Plays asked for or chosen; the fit may have fewer.
    candidates
        What was compared.
    validation
        Records that took no part.
    left_out
        Sentences about what was left out before the fit.

    Returns
    -------
    Identified
    """
    data, parametrization, operator = fitter.data, fit.parametrization, fit.operator
    free = parametrization.transform.any(axis=1)
    errors, not_told_apart = _standard_errors(data, fit)
    if fit.family == RAMBERG_OSGOOD and fitter.power_law.regression == "slope":
        # Those of a fit of the output would be too small for one of slopes.
        errors, not_told_apart = np.full(errors.size, np.nan), ()
    names = np.array(operator.parameters().names)
    if fit.family == RAMBERG_OSGOOD:
        left_out += at_limit_of_power(parametrization, fit.solution.theta)
    notes = left_out + _idle_plays(plays_wanted, parametrization.plays) + not_told_apart
    return Identified(
        model=operator,
        family=fit.family,
        delay=data.delay,
        parameter_names=tuple(str(name) for name in names[free]),
        parameter_values=operator.parameters().values[free],
        standard_errors=errors[free],
        undetermined=notes,
        metrics=metrics_by_record(data, operator, validation),
        candidates=candidates,
        status=fit.solution.status,
        iterations=fit.solution.iterations,
        used=data.used(),
        description=describe(data, fit.family),
    )


def _idle_plays(wanted: int, kept: int) -> tuple[str, ...]:
    if kept >= wanted:
        return ()
    return (
        f"{wanted - kept} of {wanted} plays came out with no weight or no radius of their own; "
        "they were left out",
    )


def _standard_errors(data: Data, fit: Fit) -> tuple[Array, tuple[str, ...]]:
    """Give standard errors of the constants, NaN where on a bound or not determined."""
    parametrization, theta = fit.parametrization, fit.solution.theta
    transform = parametrization.transform
    jacobian = model_jacobian(data, fit.operator) @ transform
    residual = model_output(data, fit.operator) - data.measured()
    inside = (theta > parametrization.lower) & (theta < parametrization.upper)
    notes: list[str] = []
    # A short record can leave several combinations open, one behind the other.
    while inside.any() and (share := undetermined_combination(jacobian[:, inside])) is not None:
        involved = np.flatnonzero(inside)[share > 0.1 * share.max()]
        notes.append(_not_told_apart(fit.operator, parametrization, involved))
        inside[involved] = False
    lengths = [window.stop - window.start for window in data.windows()]
    variance = np.full(transform.shape[0], np.nan)
    if inside.any():
        covariance = robust_covariance(jacobian[:, inside], residual, lengths)
        by_constant = transform[:, inside]
        known = transform[:, inside].any(axis=1) & ~transform[:, ~inside].any(axis=1)
        spread = np.einsum("ij,jk,ik->i", by_constant, covariance, by_constant)
        variance[known] = spread[known]
    return np.sqrt(variance), tuple(notes)


def _not_told_apart(
    operator: Operator, parametrization: Parametrization, involved: NDArray[np.intp]
) -> str:
    constants = np.flatnonzero(parametrization.transform[:, involved].any(axis=1))
    names = operator.parameters().names
    listed = ", ".join(names[i] for i in constants)
    return f"the records do not tell apart {listed}; their values are one choice of many"


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
    for number, record in enumerate(validation, 1):
        name = "validation" if len(validation) == 1 else f"validation {number}"
        metrics |= _pair(name, prepare(record, "auto", data.delay), operator)
    return metrics


def _pair(name: str, data: Data, operator: Operator) -> dict[str, Metrics]:
    """Errors with and without a free offset, in percent of the whole records' output range."""
    measured, modelled = data.measured(), model_output(data, operator)
    span = max(r.y.max() for r in data.records) - min(r.y.min() for r in data.records)
    return {
        name: error_metrics(measured, modelled, output_range=float(span)),
        f"{name}, free offset": error_metrics(
            measured, modelled, free_offset=True, output_range=float(span)
        ),
    }


def traced(found: Identified, records: Sequence[Record], options: Mapping[str, Any]) -> Identified:
    """Give a result whose model tells what it means, how good it is and where it comes from.

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
        errors=errors_of(found.metrics),
        provenance=provenance(records, options),
    )
    return replace(found, description=about, model=found.model.with_description(about))


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
    first = data.records[0]
    return ModelDescription(
        input_name=first.input_name,
        output_name=first.output_name,
        input_unit=first.input_unit,
        output_unit=first.output_unit,
        input_low=float(min(r.u.min() for r in data.records)),
        input_high=float(max(r.u.max() for r in data.records)),
        output_low=float(data.measured().min()),
        output_high=float(data.measured().max()),
        dt=first.dt,
        delay=data.delay,
        family=family,
    )

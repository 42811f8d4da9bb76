"""From a fit to the result: standard errors, what is not determined, metrics, description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.problem import Evaluation, model_output
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.identification.result.identified import Candidate, Identified
from hyst.identification.result.standard_errors import Spread, spread_of_estimates
from hyst.operators import ModelDescription, Operator
from hyst.operators.description import errors_of
from hyst.operators.provenance import provenance
from hyst.signals import Metrics, Record, error_metrics

Array = NDArray[np.float64]


def identified_from_fit(
    data: Data,
    fit: Fit,
    candidates: tuple[Candidate, ...],
    validation: Sequence[Record],
    notes: tuple[str, ...],
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

    Returns
    -------
    Identified
    """
    parametrization, operator = fit.parametrization, fit.operator
    free, constants = parametrization.free, operator.parameters()
    errors, not_told_apart = constant_errors(data, fit)
    return Identified(
        model=operator,
        family=fit.family.name,
        delay=data.delay,
        parameter_names=tuple(str(name) for name in np.array(constants.names)[free]),
        parameter_values=constants.values[free],
        standard_errors=errors[free],
        undetermined=notes + fit.family.notes(fit, data) + not_told_apart,
        metrics=metrics_by_record(data, operator, validation),
        candidates=candidates,
        status=fit.solution.status,
        iterations=fit.solution.iterations,
        used=data.used(),
        description=describe(data, fit.family.name),
    )


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


def constant_errors(data: Data, fit: Fit) -> tuple[Array, tuple[str, ...]]:
    """Give standard errors of the constants, and sentences on those that are not determined.

    Parameters
    ----------
    data
        The records.
    fit
        The final fit, in their units.

    Returns
    -------
    numpy.ndarray
        Shape (constants,), NaN where a constant is held, lies on a bound or is not determined.
    tuple of str
        One sentence for each combination that is not determined.
    """
    parametrization = fit.parametrization
    if not fit.family.estimates_noise:
        return np.full(parametrization.transform.shape[0], np.nan), ()
    spread, inside = spread_of_fit(data, fit)
    transform = parametrization.transform
    errors = np.full(transform.shape[0], np.nan)
    known = transform[:, inside].any(axis=1) & ~transform[:, ~inside].any(axis=1)
    errors[known] = spread.of(transform[np.ix_(known, inside)])
    sentences = not_told_apart(fit.operator, parametrization, spread, np.flatnonzero(inside))
    return errors, sentences


def spread_of_fit(data: Data, fit: Fit) -> tuple[Spread, NDArray[np.bool_]]:
    """Give how sure the free parameters of a fit are that lie on no bound.

    Parameters
    ----------
    data
        The records.
    fit
        The final fit, in their units.

    Returns
    -------
    Spread
        Of the parameters inside.
    numpy.ndarray
        Shape (m,), which they are.
    """
    theta, parametrization = fit.solution.theta, fit.parametrization
    evaluation = Evaluation(data, parametrization)
    inside = parametrization.inside(theta)
    jacobian = evaluation.jacobian(theta)[:, inside]
    residual = evaluation.output(theta) - data.measured()
    root = fit.family.root_weights(data)
    if root is not None:
        jacobian, residual = root[:, None] * jacobian, root * residual
    return spread_of_estimates(jacobian, residual, data.lengths(), theta[inside]), inside


def not_told_apart(
    operator: Operator, parametrization: Parametrization, spread: Spread, places: NDArray[np.intp]
) -> tuple[str, ...]:
    """Name the constants in every combination that the records do not determine.

    Parameters
    ----------
    operator
        Its constants have the names.
    parametrization
        How they follow from theta.
    spread
        Of the parameters inside their bounds.
    places
        Which of theta they are.

    Returns
    -------
    tuple of str
        Sentences, none twice.
    """
    names = operator.parameters().names
    sentences = []
    for direction in range(spread.open_directions.shape[1]):
        involved = places[spread.involved(direction)]
        constants = np.flatnonzero(parametrization.transform[:, involved].any(axis=1))
        listed = ", ".join(names[i] for i in constants)
        sentences.append(
            f"the records do not tell apart {listed}; their values are one choice of many"
            if constants.size > 1
            else f"the records do not determine {listed}; its value is one choice of many"
        )
    return tuple(dict.fromkeys(sentences))


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

"""From a fit to the result: standard errors, what is not determined, metrics, description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis
from hyst.identification.families.family import Estimates, Fit
from hyst.identification.fit.problem import Evaluation, model_output
from hyst.identification.judgement.judge import judge
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.identification.result.identified import Candidate, Identified
from hyst.identification.result.record_errors import errors_by_record
from hyst.identification.result.standard_errors import Spread, spread_of_estimates
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

    Returns
    -------
    Identified
    """
    operator, estimates = fit.operator, fit.family.estimates(fit)
    errors, not_told_apart = np.full(len(estimates.names), np.nan), tuple[str, ...]()
    if fit.family.estimates_noise:
        spread = spread_of_fit(data, fit)
        errors = spread.of(estimates.by_theta)
        not_told_apart = spread.not_told_apart(estimates)
    metrics = metrics_by_record(data, operator, validation)
    return Identified(
        model=operator,
        family=fit.family.name,
        delay=data.delay,
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
        delay_interval=(data.delay, data.delay),
        diagnosis=diagnosis,
        per_record=errors_by_record(data, operator),
    )


def traced(found: Identified, records: Sequence[Record], options: Mapping[str, Any]) -> Identified:
    """Give a result whose model tells what it means, how far it is to be trusted, and its origin.

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
    return replace(found, description=about, model=found.model.with_description(about))


@dataclass(frozen=True, eq=False)
class FitSpread:
    """How sure the free parameters of a fit are.

    Parameters
    ----------
    spread
        Of the parameters that lie on no bound.
    inside
        Shape (m,), which they are.
    noise_rms
        Of the residual, output units, the free parameters allowed for.
    """

    spread: Spread
    inside: NDArray[np.bool_]
    noise_rms: float

    def of(self, by_theta: Array) -> Array:
        """Give the standard errors of functions of theta.

        Parameters
        ----------
        by_theta
            Shape (q, m), their derivative.

        Returns
        -------
        numpy.ndarray
            Shape (q,), NaN where a function is held, depends on a parameter on its bound or is not
            determined.
        """
        errors = np.full(len(by_theta), np.nan)
        moves = by_theta[:, self.inside].any(axis=1)
        known = moves & ~by_theta[:, ~self.inside].any(axis=1)
        errors[known] = self.spread.of(by_theta[np.ix_(known, self.inside)])
        return errors

    def not_told_apart(self, estimates: Estimates) -> tuple[str, ...]:
        """Name the estimates in every combination that the records do not determine.

        Parameters
        ----------
        estimates
            With their names.

        Returns
        -------
        tuple of str
            Sentences, none of which names what another does.
        """
        disturbed = self.spread.disturbed(estimates.by_theta[:, self.inside])
        sentences = []
        for together in _joined(disturbed):
            names = ", ".join(
                name for name, one in zip(estimates.names, together, strict=True) if one
            )
            sentences.append(
                f"the records do not tell apart {names}; their values are one choice of many"
                if together.sum() > 1
                else f"the records do not determine {names}; its value is one choice of many"
            )
        return tuple(sentences)


def _joined(disturbed: NDArray[np.bool_]) -> list[NDArray[np.bool_]]:
    """Join directions that share an estimate, for any mixture of them is one, too.

    Takes shape (q, k), which estimates each direction disturbs; gives shape (q,) for each group.
    """
    groups: list[NDArray[np.bool_]] = []
    for column in disturbed.T[disturbed.any(axis=0)]:
        shared = [each for each in groups if (each & column).any()]
        groups = [each for each in groups if not (each & column).any()]
        groups.append(np.logical_or.reduce([column, *shared]))
    return groups


def spread_of_fit(data: Data, fit: Fit) -> FitSpread:
    """Find how sure the free parameters of a fit are.

    Parameters
    ----------
    data
        The records.
    fit
        The final fit, in their units.

    Returns
    -------
    FitSpread
    """
    data = fit.family.fitted(data)
    theta, parametrization = fit.solution.theta, fit.parametrization
    evaluation = Evaluation(data, parametrization)
    inside = parametrization.inside(theta)
    jacobian = evaluation.jacobian(theta)[:, inside]
    residual = evaluation.output(theta) - data.measured()
    root = fit.family.root_weights(data)
    if root is not None:
        jacobian, residual = root[:, None] * jacobian, root * residual
    gauges = parametrization.gauges
    held = np.empty((0, theta.size)) if gauges is None else gauges(theta)[1]
    spread = spread_of_estimates(jacobian, residual, data.lengths(), theta[inside], held[:, inside])
    freedom = max(residual.size - int(inside.sum()) + len(held), 1)
    return FitSpread(spread, inside, float(np.linalg.norm(residual) / np.sqrt(freedom)))


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
        smallest_swing=_smallest_swing(data.records),
    )


def _smallest_swing(records: Sequence[Record]) -> float | None:
    """Give the least way of the inputs between two turns; None if none has two."""
    extent = max(r.u.max() for r in records) - min(r.u.min() for r in records)
    swings = [swings_of(record.u, float(extent)) for record in records]
    return min((float(each.min()) for each in swings if each.size), default=None)

"""Tables of a Hammerstein identification: parameters with standard errors, metrics, description."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.data import Data, prepare
from hyst.identification.fitting import model_output
from hyst.identification.hammerstein.joint import Joint
from hyst.identification.hammerstein.uncertainty import Uncertainty, coefficients, spread_of
from hyst.operators import ModelDescription, Operator
from hyst.signals import Metrics, Record, error_metrics

Array = NDArray[np.float64]


def parameter_table(
    joint: Joint, theta: Array, sure: Uncertainty
) -> tuple[tuple[str, ...], Array, Array, tuple[str, ...]]:
    """Give names, values and standard errors, and sentences on what is not determined.

    They belong to the theta of a joint refinement, and to how sure it is. The dynamics are told by
    the coefficients of ``sum b_i q^-i / (1 + sum a_i q^-i)``.
    """
    parametrization, size = joint.front.parametrization, joint.front_size
    operator = joint.hysteresis(theta)
    constants = operator.parameters()
    free = parametrization.transform.any(axis=1)
    variance = np.einsum(
        "ij,jk,ik->i",
        parametrization.transform,
        sure.covariance[:size, :size],
        parametrization.transform,
    )
    errors = np.sqrt(np.maximum(variance, 0.0))
    errors[parametrization.transform[:, ~sure.known[:size]].any(axis=1)] = np.nan
    dynamics = joint.dynamics(theta)
    n = dynamics.order
    names = [str(name) for name in np.array(constants.names)[free]]
    names += [f"dynamics.a[{i}]" for i in range(1, n + 1)]
    names += [f"dynamics.b[{i}]" for i in range(n + 1)]
    dynamic_errors = spread_of(joint, theta, sure.covariance, coefficients)
    if not joint.feedthrough:
        dynamic_errors[n] = np.nan
    return (
        tuple(names),
        np.concatenate([constants.values[free], coefficients(dynamics)]),
        np.concatenate([errors[free], dynamic_errors]),
        _not_known(joint, theta, sure),
    )


def _not_known(joint: Joint, theta: Array, sure: Uncertainty) -> tuple[str, ...]:
    lower, upper = joint.bounds()
    bound = (theta <= lower) | (theta >= upper)
    count = int((~sure.known & ~bound).sum())
    if count == 0:
        return ()
    return (
        f"the records do not determine {count} of {theta.size} parameters of the hysteresis; their "
        "values are one choice of many and have no standard error",
    )


def metrics_of(data: Data, model: Operator, validation: Sequence[Record]) -> dict[str, Metrics]:
    """Compare the output of a model with the measured one, for data and for validation."""
    metrics = _pair("training", data, model)
    for number, record in enumerate(validation, 1):
        name = "validation" if len(validation) == 1 else f"validation {number}"
        metrics |= _pair(name, prepare(record, "auto", data.delay), model)
    return metrics


def _pair(name: str, data: Data, model: Operator) -> dict[str, Metrics]:
    measured, modelled = data.measured(), model_output(data, model)
    span = max(r.y.max() for r in data.records) - min(r.y.min() for r in data.records)
    both = {name: False, f"{name}, free offset": True}
    return {
        each: error_metrics(measured, modelled, free_offset=free, output_range=float(span))
        for each, free in both.items()
    }


def described(data: Data) -> ModelDescription:
    """Give names, units and ranges for the model file."""
    first = data.records[0]
    return ModelDescription(
        input_name=first.input_name,
        output_name=first.output_name,
        input_unit=first.input_unit,
        output_unit=first.output_unit,
        input_low=float(min(r.u.min() for r in data.records)),
        input_high=float(max(r.u.max() for r in data.records)),
        output_low=float(min(r.y.min() for r in data.records)),
        output_high=float(max(r.y.max() for r in data.records)),
        dt=first.dt,
        delay=0,
        family="hammerstein",
    )

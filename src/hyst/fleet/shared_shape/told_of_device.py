"""What a fit of one device is told as: model, errors, distance, verdict."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.fleet.shared_shape.device_fit import DeviceFit
from hyst.fleet.shared_shape.device_result import SharedIdentified, Spread
from hyst.fleet.shared_shape.device_verdict import Seen, judge_device
from hyst.fleet.shared_shape.free_constants import FreeConstants
from hyst.fleet.shared_shape.signals_used import Used
from hyst.identification.fit.bounded_least_squares import CONVERGED, ITERATION_LIMIT
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified_from_fit import describe, metrics_by_record
from hyst.operators.description import errors_of

Array = NDArray[np.float64]


def told_of_device(
    constants: FreeConstants, fit: DeviceFit, data: Data, used: Used, output_range: float
) -> SharedIdentified:
    """Give the result of one device.

    Parameters
    ----------
    constants
        The mean and its directions.
    fit
        Where the device lies.
    data, used
        Its record.
    output_range
        Unit of the fit's output.
    """
    modelled, jacobian = constants.linearized(used, fit.z)
    model = constants.operator(fit.z)
    noise = fit.population.noise
    freedom = noise.freedom + float(fit.equations.freedom[0]) / noise.correlation
    lacking = noise.lacking * output_range**2 if fit.has_population else 0.0
    spread = Spread(constants, fit.z, fit.covariance, freedom, lacking, used.dt)
    predicted = math.sqrt(float(np.mean(spread.of_output(jacobian) ** 2)))
    unit = data.records[0].output_unit
    seen = _seen(fit, used, modelled, predicted, output_range, unit)
    verdict = judge_device(seen)
    about = replace(describe(data, constants.model.description.family), verdict=verdict)
    metrics = metrics_by_record(data, model, ())
    about = replace(about, errors=errors_of(metrics))
    free = (constants.basis != 0.0).any(axis=1)
    return SharedIdentified(
        model=model.with_description(about),
        family=about.family,
        delay=data.lag,
        parameter_names=tuple(np.array(constants.names)[free].tolist()),
        parameter_values=constants.constants(fit.z)[free],
        standard_errors=spread.standard_errors()[free],
        distance=seen.distance,
        probability=seen.chance,
        predicted_error=predicted,
        noise=seen.own,
        told_by_record=fit.told_by_record,
        metrics=metrics,
        status=CONVERGED if fit.converged else ITERATION_LIMIT,
        iterations=fit.steps,
        used=(used.samples,),
        description=about,
        verdict=verdict,
        undetermined=(),
        spread=spread,
    )


def _seen(
    fit: DeviceFit, used: Used, modelled: Array, predicted: float, output_range: float, unit: str
) -> Seen:
    """Give what the record shows, in units of the user."""
    equations, population = fit.equations, fit.population
    noise = population.noise
    own = math.sqrt(float(equations.left[0] / max(float(equations.freedom[0]), 1.0)))
    known = fit.has_population
    return Seen(
        used.u[used.window],
        used.y - modelled,
        float(np.ptp(used.y)),
        own * output_range,
        math.sqrt(noise.variance) * output_range if known else own * output_range,
        math.sqrt(noise.lacking) * output_range if known else 0.0,
        predicted,
        _left_by_line(used),
        math.sqrt(float(population.excess(equations)[0])) if known else math.nan,
        float(population.chance(equations)[0]) if known else math.nan,
        float(noise.chance(equations)[0]) if known else math.nan,
        known,
        unit,
    )


def _left_by_line(used: Used) -> float:
    """Give the rms that a straight line leaves."""
    u = used.u[used.window] - used.u[used.window].mean()
    y = used.y - used.y.mean()
    squares = float(u @ u)
    slope = float(u @ y) / squares if squares > 0.0 else 0.0
    return math.sqrt(float(np.mean((y - slope * u) ** 2)))

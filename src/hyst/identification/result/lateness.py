"""What a delay that is only estimated does to a fit: its column beside those of the constants.

With J the derivative of the model's output by its constants and c that by the delay, the joint fit
of both has the delay of the part of c that no constant makes, and what the delay may be wrong by
moves the constants along ``-J^+ c``. A law that takes a rate from one sample to the next has a
second column: how its output differs where the rate is taken between samples too, as a plant does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.identification.families.family import Family, Fit
from hyst.identification.fit.block import lengths_of
from hyst.identification.fit.nuisance import Beside
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.problem import model_output, problem_of
from hyst.identification.fit.tangent import Tangent
from hyst.identification.record_use.part_of_a_sample import later
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.covariance import robust_covariance
from hyst.operators import Operator

Array = NDArray[np.float64]

STEP = 2.0**-2
"""Samples: half the way over which the derivative by the delay is a difference."""

STEPS_BETWEEN, MOST_STEPS = 16, 2**21
"""Between two samples, and of all records together: with more samples fewer, or none."""

FEWEST_STEPS = 4

FAR, ITERATIONS = 2.0, 20
"""Standard errors beyond which the way of the constants is no line any more, and what a fit there
may take."""

OWN_PART = 1e-3
"""Of a column's norm that no constant makes: with less the delay is one more name for constants."""


@dataclass(frozen=True, eq=False)
class Lateness:
    """What the records say, beside a fit, of the delay it was made with.

    Parameters
    ----------
    change
        By which the joint fit would make the delay longer, samples of the first record.
    error
        Its standard error, samples; infinite where the constants stand in for any delay.
    by_delay
        Shape (m,): how the constants inside their bounds move for each sample the delay is longer.
    between
        Shape (m,): how they are moved by taking the rate from one sample to the next where the
        plant does not, one standard error counted; 0 for laws without a rate.
    """

    change: float
    error: float
    by_delay: Array
    between: Array


def counts_delay(family: Family, evidence: DelayEvidence | None) -> bool:
    """Tell whether the delay of a fit was estimated, so that the constants are as unsure.

    Parameters
    ----------
    family
        The family.
    evidence
        Of the delay; None where it was given, or is part of the model.
    """
    if evidence is None or evidence.high <= evidence.low:
        return False
    return family.has_memory and family.settles_delay and family.loops_tell_delay is True


def moves_of(data: Data, fit: Fit, delay: DelayEvidence | None) -> Array | None:
    """Give how far the constants inside their bounds may be moved by what is not known exactly.

    Parameters
    ----------
    data, fit
        The records, with the delay of the fit.
    delay
        What the records say of it where it was estimated.

    Returns
    -------
    numpy.ndarray or None
        Shape (m, 3), each column one standard error: by the error of the delay, by as much as the
        joint fit would have another one, and by what lies between samples. None where all is known.
    """
    free = counts_delay(fit.family, delay)
    if not (free or fit.family.rate_between_samples):
        return None
    late = lateness_of(data, fit, delay_is_free=free)
    inside = fit.parametrization.inside(fit.solution.theta)
    columns = np.zeros((int(inside.sum()), 3))
    columns[:, 2] = late.between
    if free and delay is not None:
        # At most what the records leave possible before any model.
        furthest, back = max(delay.high - data.lag, 0.0), max(data.lag - delay.low, 0.0)
        change = min(max(late.change, -back), furthest)
        error = min(late.error, max(furthest, back))
        columns[:, 0], columns[:, 1] = error * late.by_delay, change * late.by_delay
        if abs(change) > FAR * late.error:
            columns[:, 1] = _moved_by(data, fit, change)[inside]
    return columns


def _moved_by(data: Data, fit: Fit, change: float) -> Array:
    """Give how all constants move with the delay where that is more than a step."""
    theta = fit.solution.theta
    there = fit.problem(data.a_little_later(change))
    return np.asarray(fit.family.solve(there, theta, ITERATIONS).theta - theta)


def lateness_of(
    data: Data, fit: Fit, chosen: NDArray[np.bool_] | None = None, *, delay_is_free: bool = True
) -> Lateness:
    """Fit the delay together with the constants, to first order about a fit.

    Parameters
    ----------
    data
        The records, with the delay of the fit.
    fit
        A fit to them.
    chosen
        Shape (samples used,): which samples count; all if left out.
    delay_is_free
        Whether the delay was estimated; else only what lies between samples is asked for.

    Returns
    -------
    Lateness
    """
    theta, parametrization = fit.solution.theta, fit.parametrization
    root = fit.family.root_weights(data)
    problem = problem_of(data, parametrization, chosen, root)
    residual = problem.residual(theta)
    columns = np.zeros((residual.size, 2))
    if delay_is_free:
        later_by, earlier_by = (
            problem_of(data.a_little_later(each), parametrization, chosen, root).residual(theta)
            for each in (STEP, -STEP)
        )
        columns[:, 0] = (later_by - earlier_by) / (2.0 * STEP)
    if fit.family.rate_between_samples:
        own = _between_samples(data, parametrization, theta, chosen, root)
        columns[: own.size, 1] = own
    tangent = Tangent.of(problem.blocks_at(theta), parametrization.inside(theta))
    return _joint(tangent, columns, residual, lengths_of(data.lengths(), chosen))


def _joint(tangent: Tangent, columns: Array, residual: Array, lengths: list[int]) -> Lateness:
    """Solve for the columns beside the constants."""
    by_columns = tangent.least_squares(columns)
    beyond = tangent.beyond(columns, by_columns)
    size = np.linalg.norm(columns, axis=0)
    own = np.linalg.norm(beyond, axis=0) > OWN_PART * size
    best, errors = np.zeros(2), np.array([np.inf, 0.0])
    if own.any():
        beyond = beyond[:, own]
        best[own] = -Tangent.of_matrix(beyond).least_squares(residual)
        rows = slice(0, sum(lengths))
        left = (residual + beyond @ best[own])[rows]
        unit = float(np.ldexp(1.0, np.frexp(np.abs(left).max(initial=0.0))[1]))
        covariance = robust_covariance(beyond[rows] / unit, left / unit, lengths)
        errors[own] = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    between = -by_columns[:, 1] * float(np.hypot(best[1], errors[1]))
    return Lateness(float(best[0]), float(errors[0]), -by_columns[:, 0], between)


def _between_samples(
    data: Data,
    parametrization: Parametrization,
    theta: Array,
    chosen: NDArray[np.bool_] | None,
    root: Array | None,
) -> Array:
    """Give how the output differs where the model runs in small steps between the samples."""
    operator = parametrization.operator(theta)
    plain = model_output(data, operator)
    steps = min(STEPS_BETWEEN, MOST_STEPS // max(sum(len(each) for each in data.records), 1))
    if steps < FEWEST_STEPS:
        return np.zeros_like(plain if chosen is None else plain[chosen])
    finer = data.joined(
        [
            _in_steps(record.u[: window.stop], steps, operator.at_sample_time(record.dt / steps))[
                window
            ]
            for record, window in zip(data.records, data.windows(), strict=True)
        ]
    )
    difference = finer - plain
    rows: NDArray[np.bool_] | slice = slice(None) if chosen is None else chosen
    difference = difference[rows] if root is None else (root * difference)[rows]
    if parametrization.nuisances is None:
        return difference
    return Beside(data, parametrization.nuisances, chosen, root).at(theta).out_of(difference)


def _in_steps(u: Array, steps: int, operator: Operator) -> Array:
    """Run a model over an input filled in between its samples, and give its output at these."""
    parts = [later(u, 1.0 - i / steps, keeps_corners=False) for i in range(1, steps)]
    # Part i of the way from the sample before to this one, then this one itself.
    fine = np.column_stack([*parts, u]).ravel()[steps - 1 :]
    return np.asarray(operator(fine)[::steps])

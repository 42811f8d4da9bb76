"""Fits to all but some samples, near the fit to all of them.

The derivatives at the fit to all samples serve every such fit: what the left-out samples add to the
normal equations is taken from them again. From there one step is nearly always enough, and whether
it was is seen by what it gained.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import (
    Problem,
    minimize,
    projected_step,
)
from hyst.identification.fit.bounded_quadratic import least_within
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.fit.normal_equations import LongSum, NormalEquations
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.problem import beside_the_records
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

TOLERANCE = 0.03
"""Of the residual variance that may be left to gain: a sixth of a standard error of a constant."""

DAMPING = 1e-9
"""Of the one step, which starts where the fit to all samples has ended."""


def normal_equations_without(
    data: Data,
    parametrization: Parametrization,
    theta: Array,
    left_out: Sequence[Rows],
    kept: Rows | None = None,
    root_weights: Array | None = None,
) -> list[NormalEquations]:
    """Give the normal equations at theta of all samples but some, each time others.

    Parameters
    ----------
    data
        The records.
    parametrization
        Free parameters, without columns beside the model.
    theta
        Where.
    left_out
        Shape (samples used,) each: those that do not count.
    kept
        Shape (samples used,): those that count in any; all if left out.
    root_weights
        Shape (samples used,): square root of every sample's weight; 1 if left out.
    """
    evaluation = Evaluation(data, parametrization)
    y = data.measured()
    errors = evaluation.output(theta) - y
    root = np.ones(y.size) if root_weights is None else root_weights.copy()
    if kept is not None:
        root[~kept] = 0.0
    weigh = kept is not None or root_weights is not None
    errors *= root
    sums = [_Sum(theta.size) for _ in range(len(left_out) + 1)]
    for block in evaluation.blocks(theta):
        here = block.rows
        jacobian = root[here, None] * block.jacobian if weigh else block.jacobian
        sums[0].add(jacobian, errors[here])
        for one, rows in zip(sums[1:], left_out, strict=True):
            if rows[here].any():
                one.add(jacobian[rows[here]], errors[here][rows[here]])
    counts = root > 0.0
    beside = beside_the_records(parametrization, float(np.linalg.norm(y - y.mean())))(theta)
    return [
        _less(sums[0], one, counts, rows, errors, beside)
        for one, rows in zip(sums[1:], left_out, strict=True)
    ]


class _Sum:
    """Products of derivatives and errors of some samples."""

    def __init__(self, size: int) -> None:
        self.matrix, self.gradient = LongSum((size, size)), LongSum((size,))

    def add(self, jacobian: Array, errors: Array) -> None:
        """Count some samples."""
        self.matrix.add(jacobian.T @ jacobian)
        self.gradient.add(jacobian.T @ errors)


def _less(
    every: _Sum,
    hidden: _Sum,
    counts: Rows,
    rows: Rows,
    errors: Array,
    beside: list[tuple[Array, Array]],
) -> NormalEquations:
    rest = errors[counts & ~rows]
    normal = NormalEquations(
        every.matrix.total - hidden.matrix.total,
        every.gradient.total - hidden.gradient.total,
        float(rest @ rest),
        rest.size,
    )
    for values, by_theta in beside:
        normal = normal.plus(values, by_theta)
    return normal


def refitted(problem: Problem, theta: Array, normal: NormalEquations, most: int) -> Array:
    """Give theta of a fit to all but some samples.

    Parameters
    ----------
    problem
        Of the samples that are left.
    theta
        Of the fit to all samples.
    normal
        The normal equations of the problem there.
    most
        Steps.
    """
    if problem.is_linear:
        moment = normal.matrix @ theta - normal.gradient
        return least_within(normal.matrix, moment, problem.lower, problem.upper, theta)
    step, promise = projected_step(problem, theta, normal, DAMPING)
    noticed = TOLERANCE * normal.cost / normal.count
    if abs(promise) <= noticed or normal.cost <= problem.negligible:
        return theta
    trial = problem.canonical(np.clip(theta + step, problem.lower, problem.upper))
    cost = problem.cost(trial)
    if abs(normal.cost - cost - promise) <= noticed:
        return trial
    start = trial if cost < normal.cost else theta
    return minimize(problem, start, most - 1, TOLERANCE).theta

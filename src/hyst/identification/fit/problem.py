"""The least squares problem of a parametrization over records."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.block import BESIDE, Block, Blocks, blocks_of
from hyst.identification.fit.bounded_least_squares import Problem
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.fit.normal_equations import NormalEquations
from hyst.identification.fit.nuisance import Beside
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.streamed import Streamed
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Operator

Array = NDArray[np.float64]

ROUNDING = 1e-12
"""A residual of this share of the output range is rounding."""

HOLDS_A_GAUGE = 10.0
"""Weight of a gauge beside the norm of the centred output: a scale must not drift."""

LARGEST_JACOBIAN = 2**20
"""Entries, 8 MB: above, normal equations are summed block by block and no Jacobian is stored."""

NO_STEP_TO = 1e3
"""Residual, over the norm of the centred output, of a theta that makes no operator."""


def model_output(data: Data, operator: Operator) -> Array:
    """Give the model's output over the samples used, all records one after the other.

    Parameters
    ----------
    data
        The records.
    operator
        The model.

    Returns
    -------
    numpy.ndarray
        Shape (samples used,).
    """
    return data.joined(
        [
            operator.at_sample_time(r.dt)(r.u[: w.stop])[w]
            for r, w in zip(data.records, data.windows(), strict=True)
        ]
    )


def model_jacobian(data: Data, operator: Operator) -> Array:
    """Give the derivative of ``model_output`` by the operator's constants.

    Parameters
    ----------
    data
        The records.
    operator
        The model.

    Returns
    -------
    numpy.ndarray
        Shape (samples used, constants).
    """
    return data.joined(
        [
            operator.at_sample_time(r.dt).jacobian(r.u[: w.stop])[w]
            for r, w in zip(data.records, data.windows(), strict=True)
        ]
    )


def problem_of(
    data: Data,
    parametrization: Parametrization,
    chosen: NDArray[np.bool_] | None = None,
    root_weights: Array | None = None,
) -> Problem:
    """Pose the least squares problem of a parametrization over all or some samples.

    Parameters
    ----------
    data
        The records.
    parametrization
        Free parameters of a family.
    chosen
        Shape (samples used,): which samples count; all if left out.
    root_weights
        Shape (samples used,): square root of every sample's weight; 1 if left out.

    Returns
    -------
    Problem

    Notes
    -----
    Columns beside the model are projected out of residual and Jacobian: L. Kaufman, A variable
    projection method for solving separable nonlinear least squares problems, BIT 15 (1975), 49-57.
    """
    y = data.measured()
    rows: NDArray[np.bool_] | slice = slice(None) if chosen is None else chosen
    root = None if root_weights is None else root_weights[rows]
    target = y[rows]
    evaluation = Evaluation(data, parametrization)
    spread = float(np.linalg.norm(y - y.mean()))
    is_allowed = parametrization.is_allowed
    beside = _beside_the_records(parametrization, spread)
    nuisances = parametrization.nuisances
    columns = None if nuisances is None else Beside(data, nuisances, chosen, root_weights)

    def errors_of(theta: Array) -> Array:
        errors = evaluation.output(theta)[rows] - target
        return errors if root is None else root * errors

    def residual(theta: Array) -> Array:
        more = [values for values, _ in beside(theta)]
        if is_allowed is not None and not is_allowed(theta):
            return np.full(target.size + sum(each.size for each in more), NO_STEP_TO * spread)
        errors = errors_of(theta)
        errors = errors if columns is None else columns.at(theta).out_of(errors)
        return np.concatenate([errors, *more]) if more else errors

    def linearize(theta: Array) -> tuple[Array, Array]:
        jacobian = evaluation.jacobian(theta)[rows]
        jacobian = jacobian if root is None else root[:, None] * jacobian
        if columns is not None:
            jacobian = projected(columns, theta, errors_of(theta), jacobian)
        more = [by_theta for _, by_theta in beside(theta)]
        return residual(theta), np.concatenate([jacobian, *more]) if more else jacobian

    is_long = target.size * parametrization.transform.shape[0] > LARGEST_JACOBIAN
    streamed = Streamed(evaluation, rows, root, columns)

    def summed(theta: Array) -> NormalEquations:
        errors = residual(theta)
        own, more = errors[: target.size], [by_theta for _, by_theta in beside(theta)]
        if is_long:
            normal = streamed.normal(theta, errors_of, own)
        else:
            normal = NormalEquations(
                *evaluation.products(theta, own, chosen, root), float(own @ own), own.size
            )
        return normal.plus(errors[own.size :], np.concatenate(more)) if more else normal

    def blocks(theta: Array) -> Blocks:
        more = [by_theta for _, by_theta in beside(theta)]
        held = np.concatenate([np.empty((0, theta.size)), *more])
        last = Block(BESIDE, slice(target.size, target.size + len(held)), held)
        if is_long:
            return lambda: itertools.chain(streamed.projected(theta, errors_of), [last])
        own = blocks_of(linearize(theta)[1][: target.size], data.lengths(chosen))
        return lambda: [*own, last]

    return Problem(
        linearize,
        residual,
        parametrization.lower,
        parametrization.upper,
        parametrization.canonical,
        negligible=float(target.size * (ROUNDING * np.ptp(y)) ** 2),
        is_linear=parametrization.is_linear,
        summed=summed if is_long or columns is None else None,
        blocks=blocks,
    )


def projected(columns: Beside, theta: Array, errors: Array, jacobian: Array) -> Array:
    """Give the derivative of a residual without its columns, which move with theta, too.

    Parameters
    ----------
    columns
        Beside the model.
    theta
        Where.
    errors, jacobian
        Shapes (samples,) and (samples, m): residual beside no columns, and its derivative.
    """
    projection = columns.at(theta)
    slopes = columns.slopes(theta, projection.coefficients(errors))
    return projection.out_of(jacobian - slopes)


def _beside_the_records(
    parametrization: Parametrization, spread: float
) -> Callable[[Array], list[tuple[Array, Array]]]:
    """Give what gives the residuals that no sample makes, with their derivative: gauges, prior."""
    gauges = parametrization.gauges
    prior = None if parametrization.prior is None else spread * parametrization.prior

    def beside(theta: Array) -> list[tuple[Array, Array]]:
        parts = []
        if gauges is not None:
            values, by_theta = gauges(theta)
            parts.append((HOLDS_A_GAUGE * spread * values, HOLDS_A_GAUGE * spread * by_theta))
        if prior is not None:
            parts.append((prior @ theta, prior))
        return parts

    return beside

"""The least squares problem of a parametrization over records."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.block import BESIDE, Block, Blocks, blocks_of, lengths_of
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

LARGEST_JACOBIAN, LARGEST_PRODUCT = 2**20, 2**23
"""Entries, 8 and 64 MB. Above the first no Jacobian is handed out, it comes block by block; above
the second normal equations are summed so as well, which takes models of many states, whose memory
has a derivative of its own, several times as long."""

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
    own = _Residual(data, parametrization, chosen, root_weights)
    is_summed = own.is_long or own.columns is None
    return Problem(
        own.linearize,
        own.residual,
        parametrization.lower,
        parametrization.upper,
        parametrization.canonical,
        negligible=own.negligible,
        is_linear=parametrization.is_linear,
        summed=own.summed if is_summed else None,
        blocks=own.blocks,
    )


class _Residual:
    """What a parametrization leaves of records, and what no sample makes after it."""

    def __init__(
        self,
        data: Data,
        parametrization: Parametrization,
        chosen: NDArray[np.bool_] | None,
        root_weights: Array | None,
    ) -> None:
        y = data.measured()
        self._chosen = chosen
        self._rows: NDArray[np.bool_] | slice = slice(None) if chosen is None else chosen
        self._root = None if root_weights is None else root_weights[self._rows]
        self._target = y[self._rows]
        self._lengths = lengths_of(data.lengths(), chosen)
        self._evaluation = Evaluation(data, parametrization)
        self._spread = float(np.linalg.norm(y - y.mean()))
        self._is_allowed = parametrization.is_allowed
        self._beside = beside_the_records(parametrization, self._spread)
        nuisances = parametrization.nuisances
        self.columns: Beside | None = None
        if nuisances is not None and nuisances.has_columns:
            self.columns = Beside(data, nuisances, chosen, root_weights)
        entries = self._target.size * parametrization.transform.shape[0]
        self.is_long = entries > LARGEST_JACOBIAN
        self._in_blocks = entries > LARGEST_PRODUCT or self.columns is not None
        self.negligible = float(self._target.size * (ROUNDING * np.ptp(y)) ** 2)
        self._streamed = Streamed(self._evaluation, self._rows, self._root, self.columns)

    def _errors(self, theta: Array) -> Array:
        """Give the residual beside no columns."""
        errors = self._evaluation.output(theta)[self._rows] - self._target
        return errors if self._root is None else self._root * errors

    def residual(self, theta: Array) -> Array:
        """Give all residuals."""
        more = [values for values, _ in self._beside(theta)]
        if self._is_allowed is not None and not self._is_allowed(theta):
            size = self._target.size + sum(each.size for each in more)
            return np.full(size, NO_STEP_TO * self._spread)
        errors = self._errors(theta)
        errors = errors if self.columns is None else self.columns.at(theta).out_of(errors)
        return np.concatenate([errors, *more]) if more else errors

    def linearize(self, theta: Array) -> tuple[Array, Array]:
        """Give all residuals and their derivative."""
        jacobian = self._evaluation.jacobian(theta)[self._rows]
        jacobian = jacobian if self._root is None else self._root[:, None] * jacobian
        if self.columns is not None:
            jacobian = projected(self.columns, theta, self._errors(theta), jacobian)
        more = [by_theta for _, by_theta in self._beside(theta)]
        return self.residual(theta), np.concatenate([jacobian, *more]) if more else jacobian

    def summed(self, theta: Array) -> NormalEquations:
        """Give the normal equations without a Jacobian of all records."""
        errors, samples = self.residual(theta), self._target.size
        own, more = errors[:samples], [by_theta for _, by_theta in self._beside(theta)]
        if self._in_blocks:
            normal = self._streamed.normal(theta, self._errors, own)
        else:
            sums = self._evaluation.products(theta, own, self._chosen, self._root)
            normal = NormalEquations(*sums, float(own @ own), samples)
        return normal.plus(errors[samples:], np.concatenate(more)) if more else normal

    def blocks(self, theta: Array) -> Blocks:
        """Give what gives the derivative block by block, that of gauges and prior last."""
        samples, more = self._target.size, [by_theta for _, by_theta in self._beside(theta)]
        held = np.concatenate([np.empty((0, theta.size)), *more])
        last = Block(BESIDE, slice(samples, samples + len(held)), held)
        if self.is_long:
            return lambda: itertools.chain(self._streamed.projected(theta, self._errors), [last])
        own = blocks_of(self.linearize(theta)[1][:samples], self._lengths)
        return lambda: [*own, last]


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


def beside_the_records(
    parametrization: Parametrization, spread: float
) -> Callable[[Array], list[tuple[Array, Array]]]:
    """Give what gives the residuals that no sample makes, with their derivative: gauges, prior.

    Parameters
    ----------
    parametrization
        With its gauges and its prior.
    spread
        Norm of the centred output.
    """
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

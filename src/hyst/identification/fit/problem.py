"""The least squares problem of a parametrization over records."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.identification.fit.bounded_least_squares import NormalEquations, Problem
from hyst.identification.fit.nuisance import Beside
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Operator

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]
Places = NDArray[np.intp]

ROUNDING = 1e-12
"""A residual of this share of the output range is rounding."""

HOLDS_A_GAUGE = 10.0
"""Weight of a gauge beside the norm of the centred output: a scale must not drift."""

NO_STEP_TO = 1e3
"""Residual, over the norm of the centred output, of a theta that makes no operator."""

FEW_CONSTANTS = 2
"""Times the free parameters: up to so many constants their products are summed, and taken to theta
after that; of more, every sample's derivatives are taken to theta first."""

SHORT_RUN = 200
"""Samples: rows in runs that are shorter on average are gathered, and summed together."""


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


@dataclass(frozen=True, eq=False)
class _Pass:
    """One record: the chain at its sample time, its input, its window, and what counts of it."""

    chain: _engine.Chain
    u: Array
    window: slice
    counts: NDArray[np.bool_] | None


class Evaluation:
    """Model outputs and their derivatives by theta over the samples used.

    The engine is given the constants as one vector; no operator is built or checked, for the bounds
    of a parametrization and its canonical form keep every theta one that makes an operator.

    Parameters
    ----------
    data
        The records.
    parametrization
        Free parameters of a model.
    """

    def __init__(self, data: Data, parametrization: Parametrization) -> None:
        self._parametrization = parametrization
        self._joined = data.joined
        self._lengths = data.lengths()
        self._start = parametrization.template.initial_state()
        chains = {
            dt: _engine.Chain(parametrization.template.at_sample_time(dt).stages())
            for dt in _sample_times(data, parametrization.template)
        }
        self._chains = tuple(chains.values())
        self._passes = [
            _Pass(
                chains.get(record.dt, self._chains[0]),
                np.ascontiguousarray(record.u[: window.stop]),
                window,
                counts,
            )
            for record, window, counts in zip(
                data.records, data.windows(), data.counted(), strict=True
            )
        ]

    def output(self, theta: Array) -> Array:
        """Give the output of the model of canonical theta, shape (samples used,)."""
        self._set(theta)
        parts = []
        for each in self._passes:
            y = np.empty((1, each.u.size))
            if each.chain.run(self._start[None, :].copy(), each.u[None, :], y) >= 0:
                self._parametrization.operator(theta)(each.u)  # names the sample that overflows
            parts.append(y[0, each.window])
        return self._joined(parts)

    def jacobian(self, theta: Array) -> Array:
        """Give its derivative by theta, shape (samples used, m)."""
        self._set(theta)
        result = np.empty((sum(self._lengths), theta.size))
        row = 0
        for each, length in zip(self._passes, self._lengths, strict=True):
            by_constants = self._rows[: each.u.size]
            each.chain.jacobian(self._start.copy(), each.u, by_constants)
            rows = by_constants[each.window]
            np.matmul(
                rows if each.counts is None else rows[each.counts],
                self._parametrization.transform,
                out=result[row : row + length],
            )
            row += length
        return result

    def products(
        self, theta: Array, errors: Array, chosen: Rows | None = None, root: Array | None = None
    ) -> tuple[Array, Array]:
        """Give ``J'J`` and ``J'e`` of some samples, J being the derivative by theta.

        Parameters
        ----------
        theta
            Canonical.
        errors
            Shape (samples chosen,), with their weights.
        chosen
            Shape (samples used,): which samples count; all if left out.
        root
            Shape (samples chosen,): square root of every sample's weight; 1 if left out.
        """
        self._set(theta)
        transform = self._parametrization.transform
        late = len(transform) <= FEW_CONSTANTS * theta.size
        size = len(transform) if late else theta.size
        matrix, gradient = np.zeros((size, size)), np.zeros(size)
        first = 0
        for each, pieces in zip(self._passes, self._pieces(chosen), strict=True):
            by_constants = self._rows[: each.u.size]
            each.chain.jacobian(self._start.copy(), each.u, by_constants)
            for piece in pieces:
                rows = by_constants[piece] if late else by_constants[piece] @ transform
                place = slice(first, first + len(rows))
                rows = rows if root is None else root[place, None] * rows
                matrix += rows.T @ rows
                gradient += rows.T @ errors[place]
                first = place.stop
        if late:
            return transform.T @ matrix @ transform, transform.T @ gradient
        return matrix, gradient

    def _pieces(self, chosen: Rows | None) -> list[list[slice] | list[Places]]:
        """Give for each record the rows of its samples that are chosen, and count."""
        ends = np.cumsum(self._lengths)[:-1]
        parts = [None] * len(self._passes) if chosen is None else np.split(chosen, ends)
        return [_pieces_of(each, part) for each, part in zip(self._passes, parts, strict=True)]

    def _set(self, theta: Array) -> None:
        constants = self._parametrization.constants(theta)
        for chain in self._chains:
            chain.set_parameters(constants)

    @functools.cached_property
    def _rows(self) -> Array:
        """Room for the derivatives by all constants; fresh memory costs more than to fill it."""
        return np.empty(
            (max(each.u.size for each in self._passes), self._chains[0].parameter_count)
        )


def _pieces_of(record: _Pass, chosen: Rows | None) -> list[slice] | list[Places]:
    """Give rows of one record as runs, which need no copy, or all at once if they are short."""
    if record.counts is None and chosen is None:
        return [record.window]
    rows = np.zeros(record.window.stop, dtype=bool)
    used = rows[record.window]
    used[slice(None) if record.counts is None else record.counts] = (
        True if chosen is None else chosen
    )
    edges = np.flatnonzero(np.diff(rows, prepend=False, append=False))
    runs = [slice(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
    if len(runs) * SHORT_RUN <= np.count_nonzero(rows):
        return runs
    return [np.flatnonzero(rows)]


def _sample_times(data: Data, operator: Operator) -> list[float]:
    """Give the sample times at which an operator differs; one for one that has none."""
    times = dict.fromkeys(record.dt for record in data.records)
    return list(times) if operator.dt is not None else [data.records[0].dt]


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

    def summed(theta: Array) -> NormalEquations:
        left = residual(theta)
        matrix, gradient = evaluation.products(theta, left[: target.size], chosen, root)
        for values, by_theta in beside(theta):
            matrix += by_theta.T @ by_theta
            gradient += by_theta.T @ values
        return NormalEquations(matrix, gradient, float(left @ left), left.size)

    return Problem(
        linearize,
        residual,
        parametrization.lower,
        parametrization.upper,
        parametrization.canonical,
        negligible=float(target.size * (ROUNDING * np.ptp(y)) ** 2),
        is_linear=parametrization.is_linear,
        summed=summed if columns is None else None,
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

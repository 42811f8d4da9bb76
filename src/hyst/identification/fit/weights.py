"""Weights of a play bank with given radii: non-negative least squares with a free offset."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.identification.fit.non_negative import non_negative
from hyst.identification.fit.play_bank import bank_gram, bank_matrix
from hyst.identification.fit.weight_rules import NON_NEGATIVE, basis
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

# Beyond this condition of the scaled Gram matrix its square root has lost half of the digits, and
# the weights are found from the QR factors of the regressors instead.
LARGEST_CONDITION = 1e8


@dataclass(frozen=True, eq=False)
class Weights:
    """Weights of the input and of the plays, and the offset.

    Parameters
    ----------
    p0
        Weight of the input, output units per input unit.
    p
        Shape (n,), weights of the plays.
    offset
        Output units.
    rms
        Root mean square residual, output units.
    condition
        2-norm condition of the scaled, centred Gram matrix.
    """

    p0: float
    p: Array
    offset: float
    rms: float
    condition: float


def fit_weights(
    data: Data,
    r: Array,
    sign: float = 1.0,
    rule: str = NON_NEGATIVE,
    chosen: NDArray[np.bool_] | None = None,
) -> Weights:
    """Fit ``y = sign (p0 u + sum_i p_i z_i) + offset`` by least squares within a rule.

    The offset is eliminated by centring; the weights solve a non-negative least squares problem
    on the Cholesky factor of the streamed Gram matrix, or on a QR factor of the regressors where
    that is ill-conditioned.

    Parameters
    ----------
    data
        The records.
    r
        Shape (n,), radii, input units.
    sign
        +1, or -1 for an actuator whose output falls as its input rises.
    rule
        ``non-negative`` or ``invertible``; see ``weight_rules``.
    chosen
        Shape (samples used,): which samples count; all if left out.

    Returns
    -------
    Weights

    Raises
    ------
    SolverError
        If the weights cannot be found.
    """
    # Raw counts of a converter vary little around a large mean, whose square would swamp them.
    u_origin = float(np.mean([each.u.mean() for each in data.records]))
    y_origin = float(data.measured().mean())
    if chosen is None:
        gram = bank_gram(data, r, u_origin, y_origin)
    else:
        gram = _gram_of(data, r, chosen, (u_origin, y_origin))
    count = gram[-2, -2]
    mean = gram[-2] / count
    centred = gram - count * np.outer(mean, mean)
    coefficients = basis(rule, r.size)
    normal = coefficients.T @ centred[:-2, :-2] @ coefficients
    moment = sign * coefficients.T @ centred[:-2, -1]
    scale = np.sqrt(np.maximum(np.diag(normal), np.finfo(float).tiny))
    correlation = normal / np.outer(scale, scale)
    condition = float(np.linalg.cond(correlation))
    factor = _cholesky(correlation) if condition < LARGEST_CONDITION else None
    if factor is not None:
        target = scipy.linalg.solve_triangular(factor, moment / scale, trans="T")
    else:
        factor, target = _by_qr(data, r, sign, coefficients / scale, chosen)
    solution = non_negative(factor, target)[0]
    free = solution / scale
    weights = coefficients @ free
    # Large weights of opposite signs cancel in the factor, but not in products of sums.
    outside = max(float(centred[-1, -1] - target @ target), 0.0)
    residual = outside + float(np.sum(np.square(factor @ solution - target)))
    return Weights(
        p0=float(weights[0]),
        p=weights[1:],
        offset=float(y_origin + mean[-1] - sign * weights @ (u_origin + mean[:-2])),
        rms=float(np.sqrt(residual / count)),
        condition=condition,
    )


def _cholesky(correlation: Array) -> Array | None:
    """Give the upper factor; None where rounding of the sums leaves the matrix without one."""
    try:
        return np.asarray(np.linalg.cholesky(correlation).T)
    except np.linalg.LinAlgError:
        return None


def _gram_of(
    data: Data, r: Array, chosen: NDArray[np.bool_], origins: tuple[float, float]
) -> Array:
    """Give the inner products of ``bank_gram`` over some of the samples."""
    matrix, y = bank_matrix(data, r)[chosen], data.measured()[chosen]
    columns = np.column_stack([matrix - origins[0], np.ones(y.size), y - origins[1]])
    return np.asarray(columns.T @ columns)


def _by_qr(
    data: Data, r: Array, sign: float, scaled_basis: Array, chosen: NDArray[np.bool_] | None
) -> tuple[Array, Array]:
    rows = slice(None) if chosen is None else chosen
    matrix = bank_matrix(data, r)[rows]
    y = sign * data.measured()[rows]
    q, factor = np.linalg.qr((matrix - matrix.mean(axis=0)) @ scaled_basis)
    return factor, q.T @ (y - y.mean())

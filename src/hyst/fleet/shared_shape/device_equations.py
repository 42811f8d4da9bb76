"""What a record says of its device, as normal equations around the mean of the fleet.

Of a device's record there stay three things, whatever its length: how its output moves with z, in
the directions the record determines, what z would be best by itself, and what is left then.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.fleet.shared_shape.free_constants import FreeConstants
from hyst.fleet.shared_shape.signals_used import Used

Array = NDArray[np.float64]

LAGS = 40
"""Autocovariances that are kept of what is left."""

SMALLEST_EIGENVALUE = 1e-9
"""Of the normal matrix: a direction with less is not determined."""


@dataclass(frozen=True, eq=False)
class Equations:
    """Normal equations of a stack of devices, each around the mean, in units of the output's range.

    ``rows' rows`` is the normal matrix and ``rows' along`` its right side; rows that are 0 stand
    for directions that a record does not determine.

    Parameters
    ----------
    rows, along
        Shapes (devices, q, q) and (devices, q).
    rank
        Shape (devices,), directions that are determined.
    left
        Shape (devices,), sum of squares that no z explains.
    lagged
        Shape (devices, LAGS + 1), sums of products of what is left with itself later.
    samples
        Shape (devices,).
    error
        Shape (devices,), sum of squares of the error where the equations were taken.
    """

    rows: Array
    along: Array
    rank: NDArray[np.intp]
    left: Array
    lagged: Array
    samples: NDArray[np.intp]
    error: Array

    @classmethod
    def stacked(cls, each: list[Self]) -> Self:
        """Put the equations of devices on one stack."""
        fields = ("rows", "along", "rank", "left", "lagged", "samples", "error")
        return cls(*(np.concatenate([getattr(one, name) for one in each]) for name in fields))

    def of(self, devices: NDArray[np.intp] | NDArray[np.bool_]) -> Self:
        """Give some of the devices."""
        fields = ("rows", "along", "rank", "left", "lagged", "samples", "error")
        return type(self)(*(getattr(self, name)[devices] for name in fields))

    @property
    def freedom(self) -> Array:
        """Samples beyond what is determined, at least 0, shape (devices,)."""
        return np.asarray(np.maximum(self.samples - self.rank, 0), dtype=np.float64)


def equations_of(constants: FreeConstants, used: Used, z: Array, output_range: float) -> Equations:
    """Take the normal equations of one record, linearised at z, around the mean.

    Parameters
    ----------
    constants
        The mean and its directions.
    used
        The record.
    z
        Shape (q,), where.
    output_range
        Unit of the output.
    """
    modelled, jacobian = constants.linearized(used, z)
    jacobian = jacobian / output_range
    here = (used.y - modelled) / output_range
    error = here + jacobian @ z
    values, vectors = scipy.linalg.eigh(jacobian.T @ jacobian, check_finite=False)
    known = values > SMALLEST_EIGENVALUE * max(float(values[-1]), 1e-300)
    roots = np.sqrt(np.where(known, values, 0.0))
    rows = roots[:, None] * vectors.T
    along = np.zeros(values.size)
    along[known] = (vectors[:, known].T @ (jacobian.T @ error)) / roots[known]
    own = vectors[:, known] @ (along[known] / roots[known])
    rest = error - jacobian @ own
    lagged = _lagged(rest)
    return Equations(
        rows[None],
        along[None],
        np.array([int(known.sum())], dtype=np.intp),
        lagged[:1],
        lagged[None],
        np.array([rest.size], dtype=np.intp),
        np.array([float(here @ here)]),
    )


def _lagged(rest: Array) -> Array:
    """Give sums of products with itself 0, 1, ... samples later; 0 beyond a quarter."""
    result = np.zeros(LAGS + 1)
    most = min(LAGS, rest.size // 4)
    # As convolution of the reversed signal, of which only these lags are asked for.
    for lag in range(most + 1):
        result[lag] = rest[lag:] @ rest[: rest.size - lag]
    return result

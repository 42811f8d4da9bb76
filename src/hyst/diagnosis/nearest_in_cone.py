"""The member of a cone nearest to many signals: the work common to all is done once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.optimize
from numpy.typing import NDArray

Array = NDArray[np.float64]

_RIDGE = 1e-9
"""Of every column's square: columns that are alike would make the factor singular."""


@dataclass(frozen=True, eq=False)
class Cone:
    """Columns with weights that are not negative, after free ones were taken out of them.

    Parameters
    ----------
    free
        Shape (m, q), orthonormal, weights of either sign.
    columns
        Shape (m, n), of unit length, orthogonal to ``free``.
    factor
        Shape (n, n), upper; its square is the columns' inner products.
    lengths
        Shape (given columns,), by which they were divided; infinite where they do not move.
    """

    free: Array
    columns: Array
    factor: Array
    lengths: Array

    @classmethod
    def of(cls, columns: Array, free: Array) -> Cone:
        """Prepare a cone.

        Parameters
        ----------
        columns
            Shape (m, n).
        free
            Shape (m, q), orthonormal.
        """
        left = columns - free @ (free.T @ columns)
        lengths = np.sqrt(np.einsum("ij,ij->j", left, left))
        lengths[lengths <= 1e-9 * float(lengths.max(initial=1e-300))] = np.inf
        left = left[:, np.isfinite(lengths)] / lengths[np.isfinite(lengths)]
        gram = left.T @ left
        gram[np.diag_indices_from(gram)] += _RIDGE
        return cls(free, left, scipy.linalg.cholesky(gram), lengths)

    def left(self, y: Array) -> Array:
        """Give what the nearest member leaves of a signal.

        Parameters
        ----------
        y
            Shape (m,).
        """
        y = y - self.free @ (self.free.T @ y)
        return np.asarray(y - self.columns @ self._nearest(y))

    def weights(self, y: Array) -> Array:
        """Give the weights of the columns as they were given.

        Parameters
        ----------
        y
            Shape (m,).
        """
        result = np.zeros(self.lengths.size)
        result[np.isfinite(self.lengths)] = self._nearest(y - self.free @ (self.free.T @ y))
        return result / self.lengths

    def _nearest(self, y: Array) -> Array:
        target = scipy.linalg.solve_triangular(self.factor, self.columns.T @ y, trans="T")
        return _weights(self.factor, np.asarray(target))


def _weights(factor: Array, target: Array) -> Array:
    """Minimise by an active set, and where that does not end by a bounded method that does."""
    try:
        return np.asarray(scipy.optimize.nnls(factor, target, maxiter=20 * len(factor) + 200)[0])
    except (RuntimeError, np.linalg.LinAlgError):
        found = scipy.optimize.lsq_linear(factor, target, (0.0, np.inf), method="bvls")
        return np.asarray(np.maximum(found.x, 0.0))

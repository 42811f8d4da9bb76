"""What the output of a model, with white noise on it, says of its free numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ROUNDING = 1e-9  # of the largest singular value of scaled columns: nothing is known below
_IN_SPAN = 1e-8  # of a constant: the model has an offset of its own
_MOVES = 1e-6  # share of a function along what is not known that is not its rounding


@dataclass(frozen=True, eq=False)
class Information:
    """Directions of the free numbers that the output shows, and those it does not.

    Parameters
    ----------
    scale
        Shape (m,): norms of the columns, 1 for columns of zeros.
    basis
        Shape (m, k): orthonormal directions of scaled numbers that keep what is held.
    values
        Shape (k,), how much the output moves along each, in its own units times root of samples.
    seen
        Shape (N, q): orthonormal basis of what the numbers, and a constant, can do to the output.
    """

    scale: Array
    basis: Array
    values: Array
    seen: Array

    @classmethod
    def of(cls, jacobian: Array, held: Array) -> Information:
        """Find what is known of numbers by their Jacobian.

        Parameters
        ----------
        jacobian
            Shape (N, m).
        held
            Shape (g, m), what must not move.
        """
        scale = np.linalg.norm(jacobian, axis=0)
        scale[scale <= np.finfo(np.float64).tiny] = 1.0
        columns = jacobian / scale
        within = scipy.linalg.null_space(held / scale) if held.size else np.eye(scale.size)
        columns = columns @ within
        # An offset is found beside the model, unless it has one itself.
        ones = np.full(len(columns), len(columns) ** -0.5)
        span, triangle = np.linalg.qr(columns)
        kept = np.abs(np.diag(triangle)) > _ROUNDING
        left = ones - span[:, kept] @ (span[:, kept].T @ ones)
        free = float(np.linalg.norm(left)) > _IN_SPAN
        if free:
            columns = columns - np.outer(ones, ones @ columns)
        seen, values, directions = np.linalg.svd(columns, full_matrices=False)
        if free:
            seen = np.column_stack([seen[:, values > _ROUNDING * values.max(initial=0.0)], ones])
        return cls(scale, within @ directions.T, values, seen)

    def standard_errors(self, rows: Array, noise: float) -> Array:
        """Give the standard errors of linear functions of the numbers.

        Parameters
        ----------
        rows
            Shape (q, m).
        noise
            Standard deviation of white noise, output units.

        Returns
        -------
        numpy.ndarray
            Shape (q,), NaN where the output does not show a function at all.
        """
        along = (rows / self.scale) @ self.basis
        known = self.values > _ROUNDING * self.values.max(initial=0.0)
        size = np.linalg.norm(along, axis=1)
        errors = noise * np.linalg.norm(along[:, known] / self.values[known], axis=1)
        missing = np.linalg.norm(along[:, ~known], axis=1)
        errors[(missing > _MOVES * size) | (size == 0.0)] = np.nan
        return np.asarray(errors)

    def unexplained(self, change: Array) -> float:
        """Give the norm of a change of the output that no change of the numbers makes."""
        return float(np.linalg.norm(change - self.seen @ (self.seen.T @ change)))

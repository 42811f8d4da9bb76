"""Columns that are projected out of residual and Jacobian, record by record."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SMALLEST_DIRECTION = 1e-9
"""Of columns brought to one size: a smaller singular value is a copy of the others."""


@dataclass(frozen=True, eq=False)
class Basis:
    """Columns of one record: an orthonormal basis of them, and what makes it of them.

    Parameters
    ----------
    orthonormal
        Shape (l, k): over the first samples, for beyond them all columns are 0.
    of_columns
        Shape (q, k): the basis is the columns times this.
    samples
        How many there are, n.
    """

    orthonormal: Array
    of_columns: Array
    samples: int

    @classmethod
    def of(cls, columns: Array) -> Basis:
        """Give the basis of some columns; copies of others count once."""
        samples = len(columns)
        if not columns.size:
            return cls(np.zeros((samples, 0)), np.zeros((columns.shape[1], 0)), samples)
        some = np.flatnonzero(columns[:, 0] if columns.shape[1] == 1 else columns.any(axis=1))
        columns = columns[: some[-1] + 1 if some.size else 1]
        size = np.linalg.norm(columns, axis=0)
        size = np.where(size > 0.0, size, 1.0)
        left, values, right = np.linalg.svd(columns / size, full_matrices=False)
        kept = values > SMALLEST_DIRECTION * max(float(values[0]), SMALLEST_DIRECTION)
        return cls(left[:, kept], right[kept].T / values[kept] / size[:, None], samples)

    def out_of(self, values: Array) -> Array:
        """Give what is left of values, shape (n,) or (n, m), beside the columns."""
        left, first = values.copy(), slice(0, len(self.orthonormal))
        left[first] -= self.orthonormal @ (self.orthonormal.T @ values[first])
        return left

    def along(self, values: Array) -> Array:
        """Give what of values, shape (n,), is along each direction of the basis."""
        return np.asarray(self.orthonormal.T @ values[: len(self.orthonormal)])


@dataclass(frozen=True, eq=False)
class Projection:
    """Takes columns out of what there is for every sample, record by record.

    Parameters
    ----------
    bases
        Of the columns of each record.
    """

    bases: list[Basis]

    @property
    def directions(self) -> int:
        """How many coefficients the records have for them in all."""
        return sum(each.orthonormal.shape[1] for each in self.bases)

    def out_of(self, values: Array) -> Array:
        """Give what is left of values beside the columns.

        Parameters
        ----------
        values
            Shape (samples,) or (samples, m).
        """
        pieces = zip(self.bases, self._pieces(values), strict=True)
        return np.concatenate([each.out_of(piece) for each, piece in pieces])

    def coefficients(self, values: Array) -> list[Array]:
        """Give what the columns of each record are best multiplied by to make some values.

        Parameters
        ----------
        values
            Shape (samples,).
        """
        pieces = zip(self.bases, self._pieces(values), strict=True)
        return [each.of_columns @ each.along(piece) for each, piece in pieces]

    def _pieces(self, values: Array) -> list[Array]:
        return np.split(values, np.cumsum([each.samples for each in self.bases])[:-1])

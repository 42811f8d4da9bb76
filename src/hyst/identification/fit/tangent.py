"""Least squares by the columns of a derivative that comes block by block."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.block import Block, Blocks
from hyst.identification.fit.normal_equations import LongSum

Array = NDArray[np.float64]

SMALLEST_DIRECTION = 1e-9
"""Of columns of one size."""


@dataclass(frozen=True, eq=False)
class Tangent:
    """Columns over all samples, of which no more than a block is held, and the inverse of J'J.

    Parameters
    ----------
    blocks
        The derivative.
    columns
        Shape (m,), which of its columns are meant.
    unit
        Sizes of these columns.
    inverse
        Of the products of the columns over their sizes, where they determine it.
    """

    blocks: Blocks
    columns: NDArray[np.bool_]
    unit: Array
    inverse: Array

    @classmethod
    def of(cls, blocks: Blocks, columns: NDArray[np.bool_]) -> Self:
        """Sum the products of some columns.

        Parameters
        ----------
        blocks, columns
            As of the class.
        """
        largest = np.zeros(int(columns.sum()))
        for each in blocks():
            size = np.abs(each.jacobian[:, columns]).max(axis=0, initial=0.0)
            largest = np.maximum(largest, size)
        # By powers of two first: squares of what is tiny would underflow.
        unit = np.where(largest > 0.0, np.ldexp(1.0, np.frexp(largest)[1]), 1.0)
        products = LongSum((unit.size, unit.size))
        for each in blocks():
            rows = each.jacobian[:, columns] / unit
            products.add(rows.T @ rows)
        size = np.sqrt(np.diag(products.total))
        size = np.where(size > 0.0, size, 1.0)
        eigenvalues, vectors = np.linalg.eigh(products.total / np.outer(size, size))
        kept = eigenvalues > SMALLEST_DIRECTION * max(float(eigenvalues[-1]), 1e-300)
        inverse = vectors[:, kept] / eigenvalues[kept] @ vectors[:, kept].T
        return cls(blocks, columns, unit * size, inverse)

    @classmethod
    def of_matrix(cls, matrix: Array) -> Self:
        """Take columns as they are, shape (N, m)."""
        whole = [Block(0, slice(0, len(matrix)), matrix)]
        return cls.of(lambda: whole, np.ones(matrix.shape[1], dtype=bool))

    def least_squares(self, values: Array) -> Array:
        """Give the columns' best coefficients; what is not determined stays 0.

        Parameters
        ----------
        values
            Shape (N,) or (N, k).
        """
        unit = self.unit[:, None] if values.ndim == 2 else self.unit
        found = self.inverse @ self._products(values)
        # Once more for the digits that the normal matrix lost.
        left = self.beyond(values, found / unit)
        return np.asarray((found + self.inverse @ self._products(left)) / unit)

    def beyond(self, values: Array, coefficients: Array) -> Array:
        """Give what is left of values beside the columns times coefficients."""
        left = values.copy()
        for each in self.blocks():
            left[each.rows] -= each.jacobian[:, self.columns] @ coefficients
        return left

    def _products(self, values: Array) -> Array:
        total = LongSum((self.unit.size, *values.shape[1:]))
        for each in self.blocks():
            total.add((each.jacobian[:, self.columns] / self.unit).T @ values[each.rows])
        return total.total

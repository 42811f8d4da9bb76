"""Normal equations of records that are too long for a Jacobian of all their samples."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.block import Block
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.fit.normal_equations import LongSum, NormalEquations
from hyst.identification.fit.nuisance import Beside

Array = NDArray[np.float64]
Rows = NDArray[np.bool_] | slice


class Streamed:
    """Derivatives of a residual, block by block.

    Parameters
    ----------
    evaluation
        Of the model.
    rows
        Which of the samples used count: a mask, or all.
    root
        Shape (samples that count,): square root of every sample's weight; None for 1.
    columns
        Beside the model, projected out; None where there are none.
    """

    def __init__(
        self, evaluation: Evaluation, rows: Rows, root: Array | None, columns: Beside | None
    ) -> None:
        self._evaluation = evaluation
        self._mask = None if isinstance(rows, slice) else rows
        self._root = root
        self._columns = columns

    def normal(
        self, theta: Array, errors_of: Callable[[Array], Array], residual: Array
    ) -> NormalEquations:
        """Sum the normal equations at theta.

        Parameters
        ----------
        theta
            Where.
        errors_of
            Gives the residual beside no columns.
        residual
            The residual, without the columns.
        """
        matrix, gradient = LongSum((theta.size, theta.size)), LongSum((theta.size,))
        along = _Along(self._columns, theta)
        for block in self.blocks(theta, errors_of):
            matrix.add(block.jacobian.T @ block.jacobian)
            gradient.add(block.jacobian.T @ residual[block.rows])
            along.add(block)
        # The residual holds nothing along the columns, so that its product needs no correction.
        total = matrix.total - along.squares()
        return NormalEquations(total, gradient.total, float(residual @ residual), residual.size)

    def projected(self, theta: Array, errors_of: Callable[[Array], Array]) -> Iterator[Block]:
        """Give the derivative of the residual of samples that count, the columns taken out.

        Parameters
        ----------
        theta, errors_of
            As of ``normal``.
        """
        if self._columns is None:
            yield from self.blocks(theta, errors_of)
            return
        along = _Along(self._columns, theta)
        for block in self.blocks(theta, errors_of):
            along.add(block)
        for block in self.blocks(theta, errors_of):
            yield replace(block, jacobian=along.out_of(block))

    def blocks(self, theta: Array, errors_of: Callable[[Array], Array]) -> Iterator[Block]:
        """Give the derivative of the residual of samples that count; columns are still in it.

        Parameters
        ----------
        theta, errors_of
            As of ``normal``.
        """
        coefficients = None
        if self._columns is not None:
            coefficients = self._columns.at(theta).coefficients(errors_of(theta))
        first, record, begun = 0, -1, 0
        for block in self._evaluation.blocks(theta):
            jacobian = block.jacobian
            if self._mask is not None:
                jacobian = jacobian[self._mask[block.rows]]
            rows = slice(first, first + len(jacobian))
            first = rows.stop
            if block.record != record:
                record, begun = block.record, rows.start
            if self._root is not None:
                jacobian *= self._root[rows, None]
            if coefficients is not None and self._columns is not None:
                own = slice(rows.start - begun, rows.stop - begun)
                slopes = self._columns.slopes_of(record, own, theta, coefficients[record])
                jacobian = jacobian - slopes
            yield Block(record, rows, jacobian)


class _Along:
    """What of a derivative is along the columns that are projected out of it."""

    def __init__(self, columns: Beside | None, theta: Array) -> None:
        self._bases = [] if columns is None else columns.at(theta).bases
        ends = np.cumsum([0, *(each.samples for each in self._bases)])
        self._firsts = ends[:-1]
        self._sums = [LongSum((each.orthonormal.shape[1], theta.size)) for each in self._bases]

    def add(self, block: Block) -> None:
        """Count one block."""
        if self._bases:
            rows = self._rows(block)
            self._sums[block.record].add(rows.T @ block.jacobian[: len(rows)])

    def out_of(self, block: Block) -> Array:
        """Give what is left of a block once all were counted."""
        rows, left = self._rows(block), block.jacobian.copy()
        left[: len(rows)] -= rows @ self._sums[block.record].total
        return left

    def _rows(self, block: Block) -> Array:
        """Give the orthonormal columns over a block; beyond their end they are 0."""
        first = int(self._firsts[block.record])
        own = slice(block.rows.start - first, block.rows.stop - first)
        return self._bases[block.record].orthonormal[own]

    def squares(self) -> Array | float:
        """Give the sum of the products of what was counted."""
        return sum((each.total.T @ each.total for each in self._sums), 0.0)

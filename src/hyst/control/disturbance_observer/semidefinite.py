"""Semidefinite programs in the form Clarabel solves.

CVXPY would read nicer, but importing it and compiling a program takes a second, as long as all of
the design; the tests build the same programs with it and compare.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from hyst.errors import MissingExtraError, SolverError

Array = NDArray[np.float64]
Affine = Callable[[Array], Array]


@dataclass(frozen=True)
class Solution:
    """The ``point`` of least cost, its ``cost``, and the ``bound`` of the dual below it."""

    point: Array
    cost: float
    bound: float


class SemidefiniteProgram:
    """Least ``cost x`` with all of some affine symmetric matrices of x positive semidefinite.

    Parameters
    ----------
    size
        Number of unknowns.
    matrices
        Functions of x, affine, each with a symmetric matrix as its value. They are called once for
        each unknown, here and never again: many costs may follow.
    """

    def __init__(self, size: int, matrices: Sequence[Affine]) -> None:
        self.size = size
        zero = np.zeros(size)
        columns, constants, self._sides = [], [], []
        for matrix in matrices:
            constant = _vector(matrix(zero))
            of_each = [_vector(matrix(unit)) - constant for unit in np.eye(size)]
            columns.append(np.array(of_each).T)
            constants.append(constant)
            self._sides.append(matrix(zero).shape[0])
        self._A = scipy.sparse.csc_matrix(-np.vstack(columns))
        self._b = np.concatenate(constants)

    def solve(self, cost: Array, task: str) -> Solution:
        """Minimize.

        Parameters
        ----------
        cost
            (size,).
        task
            What messages call it.

        Raises
        ------
        SolverError
            If Clarabel ends with anything but a solution, and for what reason.
        MissingExtraError
            If Clarabel is not installed.
        """
        clarabel = _clarabel()
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        cones = [clarabel.PSDTriangleConeT(side) for side in self._sides]
        nothing = scipy.sparse.csc_matrix((self.size, self.size))
        solver = clarabel.DefaultSolver(nothing, cost, self._A, self._b, cones, settings)
        result = solver.solve()
        status = str(result.status)
        if status not in ("Solved", "AlmostSolved", "InsufficientProgress"):
            raise SolverError(
                f"the semidefinite program of {task} ended as {status}; scale the weights towards "
                "1, move poles of weights away from the axis, or use method='descent'"
            )
        return Solution(np.array(result.x), float(result.obj_val), float(result.obj_val_dual))


def symmetric(vector: Array, side: int) -> Array:
    """Give the symmetric matrix, of the given side, whose upper triangle is the vector."""
    matrix = np.zeros((side, side))
    matrix[np.triu_indices(side)] = vector
    return np.asarray(matrix + matrix.T - np.diag(np.diag(matrix)))


def upper_triangle(matrix: Array) -> Array:
    """Give the vector that ``symmetric`` takes."""
    return np.asarray(matrix[np.triu_indices(matrix.shape[0])])


def _vector(matrix: Array) -> Array:
    """Clarabel's order: the upper triangle by columns, entries off the diagonal times sqrt 2."""
    side = matrix.shape[0]
    row, column = np.tril_indices(side)[::-1]
    return np.asarray(matrix[row, column] * np.where(row == column, 1.0, np.sqrt(2.0)))


def _clarabel() -> Any:
    try:
        import clarabel  # optional
    except ImportError:
        raise MissingExtraError(
            "clarabel is not installed; pip install hyst[control], or use method='descent'"
        ) from None
    return clarabel

"""What a least squares step needs of residual and Jacobian, however many samples they have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """Products of residual e and Jacobian J.

    Parameters
    ----------
    matrix
        ``J'J``, shape (m, m).
    gradient
        ``J'e``, shape (m,).
    cost
        ``e'e``.
    count
        Number of residuals.
    """

    matrix: Array
    gradient: Array
    cost: float
    count: int

    @classmethod
    def of(cls, residual: Array, jacobian: Array) -> Self:
        """Make them of residual and Jacobian.

        Parameters
        ----------
        residual
            Shape (N,).
        jacobian
            Shape (N, m).
        """
        cost = float(residual @ residual)
        return cls(jacobian.T @ jacobian, jacobian.T @ residual, cost, residual.size)

    def over(self, change: Array) -> NormalEquations:
        """Pose them over other parameters.

        Parameters
        ----------
        change
            Shape (m, n), derivative of the parameters by the others.
        """
        return NormalEquations(
            change.T @ self.matrix @ change, change.T @ self.gradient, self.cost, self.count
        )

    def plus(self, residual: Array, jacobian: Array) -> NormalEquations:
        """Add further residuals.

        Parameters
        ----------
        residual, jacobian
            As of ``of``.
        """
        more = NormalEquations.of(residual, jacobian)
        return NormalEquations(
            self.matrix + more.matrix,
            self.gradient + more.gradient,
            self.cost + more.cost,
            self.count + more.count,
        )


class LongSum:
    """A sum of many arrays of one shape that keeps what each addition rounds off.

    Parameters
    ----------
    shape
        Of the arrays.

    Notes
    -----
    O. Moller, Quasi double-precision in floating point addition, BIT 5 (1965), 37-50; D. E. Knuth,
    The art of computer programming, vol. 2, section 4.2.2, theorem B.
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        self._total = np.zeros(shape)
        self._lost = np.zeros(shape)

    def add(self, part: Array) -> None:
        """Add one array."""
        before = self._total
        self._total = before + part
        share = self._total - before
        self._lost += (before - (self._total - share)) + (part - share)

    @property
    def total(self) -> Array:
        """What was added."""
        return self._total + self._lost

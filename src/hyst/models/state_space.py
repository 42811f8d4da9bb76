"""What follows from the matrices of a sampled state space with one input and one output."""

from __future__ import annotations

import math
from abc import abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.models.linear_properties import answers_after, poles_of, values_at, zeros_of
from hyst.operators.base import Operator

Array = NDArray[np.float64]


class StateSpace(Operator):
    """A sampled system ``x_{k+1} = A x_k + B w_k, y_k = C x_k + D w_k, w_k = u_{k-delay}``."""

    A: Array
    B: Array
    C: Array
    D: float
    delay: int

    @property
    @abstractmethod
    def dt(self) -> float:
        """Sample time, s."""

    @property
    def order(self) -> int:
        """Number of states n, the delay not counted."""
        return int(self.B.size)

    def poles(self) -> NDArray[np.complex128]:
        """Give the eigenvalues of A, the largest modulus first; those of the delay are left out."""
        return poles_of(self.A)

    def relative_degree(self) -> int:
        """Give the number of samples, delay included, until the output answers.

        That of the zero system is its order plus one, plus the delay.
        """
        return answers_after(self.A, self.B, self.C, self.D) + self.delay

    def zeros(self) -> NDArray[np.complex128]:
        """Give the finite zeros, the largest modulus first; the delay adds none."""
        return zeros_of(self.A, self.B, self.C, self.D)

    def is_stable(self) -> bool:
        """Tell whether all poles lie inside the unit circle."""
        return self.order == 0 or bool(np.abs(self.poles()[0]) < 1.0)

    def dc_gain(self) -> float:
        """Give the gain at rest, ``C (I - A)^-1 B + D``; infinity for a pole at 1."""
        try:
            return float(self.C @ np.linalg.solve(np.eye(self.order) - self.A, self.B)) + self.D
        except np.linalg.LinAlgError:
            return math.inf

    def frequency_response(self, frequency: ArrayLike) -> NDArray[np.complex128]:
        """Give ``G(exp(2 pi i f dt))``.

        Parameters
        ----------
        frequency
            Shape (m,), Hz.
        """
        angle = 2.0 * np.pi * self.dt * np.atleast_1d(np.asarray(frequency, dtype=np.float64))
        points = np.exp(1j * angle)
        return np.asarray(values_at(points, self.A, self.B, self.C, self.D) / points**self.delay)

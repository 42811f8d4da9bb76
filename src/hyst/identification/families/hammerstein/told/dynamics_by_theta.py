"""Poles, zeros and frequency response of G with their exact derivatives by all free parameters.

They follow from the derivatives of A, B, C and D, which are constants of the model and so affine in
the free parameters, whichever of them are free.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.joint import JointParametrization
from hyst.models import LinearDynamics

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_AT_A_TIME = 4096


@dataclass(frozen=True, eq=False)
class DynamicsByTheta:
    """Linear dynamics with the derivatives of their matrices by m free parameters.

    Parameters
    ----------
    dynamics
        G.
    A, B, C, D
        Shapes (n, n, m), (n, m), (n, m), (m,).
    """

    dynamics: LinearDynamics
    A: Array
    B: Array
    C: Array
    D: Array

    @classmethod
    def of(cls, parametrization: JointParametrization, theta: Array) -> DynamicsByTheta:
        """Take the derivatives from the free parameters of hysteresis and dynamics.

        Parameters
        ----------
        parametrization
            Of both; the constants of the dynamics are the last.
        theta
            Its free parameters.
        """
        dynamics = parametrization.dynamics(theta)
        n = dynamics.order
        rows = parametrization.transform[-(n * n + 2 * n + 1) :]
        A, B, C, D = np.split(rows, [n * n, n * n + n, n * n + 2 * n])
        return cls(dynamics, A.reshape(n, n, theta.size), B, C, D[0])

    @property
    def is_held(self) -> bool:
        """Whether no free parameter moves the dynamics."""
        return not any(each.any() for each in (self.A, self.B, self.C, self.D))

    def poles(self) -> tuple[Complex, Complex]:
        """Give the poles, ordered by real, then imaginary part, and their derivative (n, m).

        It is ``w' dA v`` with the eigenvectors scaled to ``w' v = 1``; not finite where two poles
        are one.
        """
        poles, right = np.linalg.eig(self.dynamics.A)
        order = np.lexsort((poles.imag, poles.real))
        with np.errstate(all="ignore"):
            try:
                left = np.linalg.inv(right)
            except np.linalg.LinAlgError:
                left = np.full(right.shape, np.nan)
            by_theta = np.einsum("ij,jkm,ki->im", left, self.A, right)
        return poles[order].astype(np.complex128), by_theta[order].astype(np.complex128)

    def zeros(self) -> tuple[Complex, Complex]:
        """Give the finite zeros, ordered as the poles, and their derivative, shape (q, m).

        At a zero ``G(z) = 0``, so it moves by ``-(dG/dtheta) / (dG/dz)``; not finite where two of
        them are one, or one of them is a pole.
        """
        zeros = self.dynamics.zeros()
        zeros = zeros[np.lexsort((zeros.imag, zeros.real))]
        with np.errstate(all="ignore"):
            by_theta = np.array([self._zero_by_theta(each) for each in zeros])
        return zeros, by_theta.reshape(zeros.size, self.D.size)

    def response(self, frequency: Array) -> tuple[Complex, Complex]:
        """Give ``G(exp(2 pi i f dt))`` with the delay, and its derivative, shape (p, m).

        Parameters
        ----------
        frequency
            Shape (p,), Hz.
        """
        points = np.exp(2j * np.pi * self.dynamics.dt * frequency)
        response = self.dynamics.frequency_response(frequency)
        parts = [
            self._value_by_theta(points[start : start + _AT_A_TIME])
            for start in range(0, points.size, _AT_A_TIME)
        ]
        by_theta = np.concatenate([np.zeros((0, self.D.size)), *parts])
        return response, by_theta / points[:, None] ** self.dynamics.delay

    def _value_by_theta(self, points: Complex) -> Complex:
        """Differentiate ``D + C (z - A)^-1 B`` at points z, shape (p, m)."""
        G, n = self.dynamics, self.dynamics.order
        matrices = points[:, None, None] * np.eye(n) - G.A
        x = np.linalg.solve(matrices, np.broadcast_to(G.B[:, None], (points.size, n, 1)))[..., 0]
        rows = np.broadcast_to(G.C[:, None], (points.size, n, 1))
        w = np.linalg.solve(matrices.transpose(0, 2, 1), rows)[..., 0]
        by_a = np.einsum("pj,jkm,pk->pm", w, self.A, x)
        return np.asarray(by_a + w @ self.B + x @ self.C + self.D)

    def _zero_by_theta(self, zero: complex) -> Complex:
        G, n = self.dynamics, self.dynamics.order
        matrix = zero * np.eye(n) - G.A
        try:
            x, w = np.linalg.solve(matrix, G.B), np.linalg.solve(matrix.T, G.C)
        except np.linalg.LinAlgError:
            return np.full(self.D.size, complex(np.nan, np.nan))
        by_a = np.einsum("j,jkm,k->m", w, self.A, x)
        return np.asarray((by_a + w @ self.B + x @ self.C + self.D) / (w @ x))

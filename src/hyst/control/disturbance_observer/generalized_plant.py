"""The weighted plant of eq. 37, minimal and scaled, around which L is a static feedback."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.certificate import weighted_loop
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.linear_system import LinearSystem, balanced

Array = NDArray[np.float64]

_NEGLIGIBLE = 1e-9  # of a balanced matrix: what lies below is no coupling of states


@dataclass(frozen=True)
class GeneralizedPlant:
    """``dx/dt = A x + B1 d + B2 u, z = C1 x + D11 d, e = C2 x``, closed by ``u = L_scaled e``.

    Time is in units of 1/``scale``; ``A`` (n, n), ``B1``, ``B2``, ``C1``, ``C2`` and ``D11`` are
    balanced; ``removed`` states were neither reached nor seen. The gain in the units of the
    problem is ``gain_units * L_scaled``.
    """

    A: Array
    B1: Array
    B2: Array
    C1: Array
    C2: Array
    D11: Array
    scale: float
    removed: int
    gain_units: Array

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.A)


def generalized_plant(problem: ObserverProblem) -> GeneralizedPlant:
    """Join the problem's plant, controller, observer without gain and weights.

    States nothing reaches or nothing shows are removed, time is scaled to the middle of the poles,
    states are balanced, and so are the rows of L, so that all numbers are near 1.
    """
    open_loop = weighted_loop(problem, np.zeros(problem.order))
    n, first = open_loop.order, problem.plant.order + problem.controller.order
    into_observer = np.zeros((n, problem.order))
    into_observer[first : first + problem.order] = np.eye(problem.order)
    innovation = np.zeros((1, n))
    innovation[:, : problem.plant.order] = problem.plant.C
    innovation[:, first : first + problem.plant.order] = -problem.plant.C
    rates = np.abs(open_loop.poles())
    rates = rates[rates > 1e-9 * rates.max()]
    scale = float(np.exp(np.mean(np.log(rates))))
    # The rate of the innovation's states is that of the observer: rows of L take its units.
    widened = LinearSystem(
        open_loop.A / scale,
        np.hstack([open_loop.B / np.sqrt(scale), into_observer]),
        np.vstack([open_loop.C / np.sqrt(scale), innovation]),
        np.block([[open_loop.D, np.zeros((2, problem.order))], [np.zeros((1, 1 + problem.order))]]),
    )
    plain = balanced(widened)
    small = _observed(_reached(plain))
    columns = np.linalg.norm(small.B[:, 1:], axis=0)
    row = float(np.linalg.norm(small.C[2]))
    return GeneralizedPlant(
        A=small.A,
        B1=small.B[:, :1],
        B2=small.B[:, 1:] / columns,
        C1=small.C[:2],
        C2=small.C[2:] / row,
        D11=small.D[:2, :1],
        scale=scale,
        removed=plain.order - small.order,
        gain_units=scale / (columns * row),
    )


def _reached(system: LinearSystem) -> LinearSystem:
    """Keep the states that the inputs reach, in an orthonormal basis (staircase)."""
    basis = _span(system.A, system.B)
    return LinearSystem(basis.T @ system.A @ basis, basis.T @ system.B, system.C @ basis, system.D)


def _observed(system: LinearSystem) -> LinearSystem:
    """Keep the states that the outputs show."""
    basis = _span(system.A.T, system.C.T)
    return LinearSystem(basis.T @ system.A @ basis, basis.T @ system.B, system.C @ basis, system.D)


def _span(A: Array, B: Array) -> Array:
    """Orthonormal basis of all A^k B, each new direction orthogonal to those before."""
    n = A.shape[0]
    basis = np.zeros((n, 0))
    block = B / np.maximum(np.linalg.norm(B, axis=0), 1e-300)
    size = max(float(np.linalg.norm(A, 2)), 1e-300)
    while block.shape[1] and basis.shape[1] < n:
        # Twice is enough: the second pass takes off what rounding left of the first.
        for _ in range(2):
            block = block - basis @ (basis.T @ block)
        left, values, _ = np.linalg.svd(block, full_matrices=False)
        new = left[:, values > _NEGLIGIBLE]
        basis = np.hstack([basis, new])
        block = A @ new / size
    return basis

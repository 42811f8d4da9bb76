"""What a disturbance observer is designed for, read and ready for computation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.internal_model import InternalModel
from hyst.control.linear_system import LinearSystem

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class ObserverProblem:
    """Nominal plant, controller, weights and internal model of one design.

    ``observer_problem`` makes one from what a user has, and checks it.

    Parameters
    ----------
    plant, controller
        Pn and C, each with one input and one output, in continuous time.
    Wu, Wp
        Weights of the multiplicative uncertainty and of 1 - Q.
    internal_model
        Of the disturbance.
    Wn
        Weight of the gain from the sensor's noise to the drive; None if none is asked for.
    """

    plant: LinearSystem
    controller: LinearSystem
    Wu: LinearSystem
    Wp: LinearSystem
    internal_model: InternalModel
    Wn: LinearSystem | None = None

    @property
    def order(self) -> int:
        """Number of states of the observer, and of gains."""
        return self.plant.order + self.internal_model.order

    def augmented(self) -> tuple[Array, Array, Array, Array]:
        """Matrices of plant and internal model together, eq. 30, and the row that gives d."""
        n, n_d = self.plant.order, self.internal_model.order
        A = np.zeros((n + n_d, n + n_d))
        A[:n, :n] = self.plant.A
        A[:n, n:] = self.plant.B @ self.internal_model.C_d
        A[n:, n:] = self.internal_model.A_d
        B = np.vstack([self.plant.B, np.zeros((n_d, 1))])
        C = np.hstack([self.plant.C, np.zeros((1, n_d))])
        of_disturbance = np.hstack([np.zeros((1, n)), self.internal_model.C_d])
        return A, B, C, of_disturbance

    def observer(self, gain: Array) -> LinearSystem:
        """Give the Luenberger observer of eq. 32: inputs v and y, output the estimate of d.

        Parameters
        ----------
        gain
            L, (order,).
        """
        A, B, C, of_disturbance = self.augmented()
        L = np.asarray(gain, dtype=np.float64).reshape(-1, 1)
        return LinearSystem(A - L @ C, np.hstack([B, L]), of_disturbance, np.zeros((1, 2)))

    def q_filter(self, gain: Array) -> LinearSystem:
        """Give Q(s), eq. 34b: from d to its estimate on the nominal plant.

        Parameters
        ----------
        gain
            L, (order,).
        """
        A, B, C, of_disturbance = self.augmented()
        L = np.asarray(gain, dtype=np.float64).reshape(-1, 1)
        return LinearSystem(A - L @ C, -B, of_disturbance, np.zeros((1, 1)))

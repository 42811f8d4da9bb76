"""What an observer in discrete time is designed for, read and ready for computation."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.disturbance_observer.internal_model import InternalModel
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.linear_system import LinearSystem
from hyst.control.sampled.plant import SampledPlant

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SampledObserverProblem(ObserverProblem):
    """Sampled plant and controller, weights and internal model of one design.

    Parameters
    ----------
    plant
        Pd: hold, delay and P, sampled; the delay is among its states.
    controller
        C, sampled.
    Wu, Wp
        Weights over frequency, continuous or sampled.
    internal_model
        Of the disturbance, in continuous time, 1/s.
    sampled
        The plant with what is known of it in continuous time.
    Wn
        Weight of K S, the gain from the sensor's noise to the drive; None if none is asked for.
    """

    sampled: SampledPlant = field(kw_only=True)

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self.sampled.dt

    @property
    def sampled_model(self) -> InternalModel:
        """The internal model from one sample to the next."""
        return sampled_model(self.internal_model, self.dt)

    def augmented(self) -> tuple[Array, Array, Array, Array]:
        """Matrices of plant and internal model together, eq. 30, and the row that gives d."""
        return ObserverProblem(
            self.plant, self.controller, self.Wu, self.Wp, self.sampled_model
        ).augmented()

    def correction(self, gain: Array) -> float:
        """Give what the sample of y itself corrects in the estimate, ``C_d A_d^-1 L_d``.

        Parameters
        ----------
        gain
            L, (order,).
        """
        model = self.sampled_model
        L_d = np.asarray(gain, dtype=np.float64)[self.plant.order :]
        return float((model.C_d @ np.linalg.solve(model.A_d, L_d))[0])

    def observer(self, gain: Array) -> LinearSystem:
        """Give the observer of eq. 32, sampled: inputs v and y, output the estimate of d.

        ``d_hat_k`` is already corrected by y_k, which saves a sample of delay.

        Parameters
        ----------
        gain
            L, (order,).
        """
        A, B, C, of_disturbance = self.augmented()
        L, now = np.asarray(gain, dtype=np.float64).reshape(-1, 1), self.correction(gain)
        return LinearSystem(
            A - L @ C, np.hstack([B, L]), of_disturbance - now * C, np.array([[0.0, now]]), self.dt
        )

    def q_filter(self, gain: Array) -> LinearSystem:
        """Give Q(z): from d to its estimate on the nominal plant.

        Parameters
        ----------
        gain
            L, (order,).
        """
        A, B, C, of_disturbance = self.augmented()
        L, now = np.asarray(gain, dtype=np.float64).reshape(-1, 1), self.correction(gain)
        return LinearSystem(A - L @ C, B, now * C - of_disturbance, np.zeros((1, 1)), self.dt)


def sampled_model(model: InternalModel, dt: float) -> InternalModel:
    """Take an internal model from one sample to the next: exp(A_d dt), C_d."""
    return InternalModel(scipy.linalg.expm(model.A_d * dt), model.C_d)

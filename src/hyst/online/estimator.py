"""What every estimator that follows a whole model is."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.online.checks import samples_of
from hyst.online.estimator_file import Saved
from hyst.online.joint.innovation import Innovation
from hyst.online.knowledge import Knowledge, knowledge_from
from hyst.online.trajectory import Trajectory
from hyst.operators import Operator
from hyst.signals import Record

Array = NDArray[np.float64]


class Estimator(Saved):
    """Constants of a model, estimated sample by sample, with which it can be inverted at any time.

    ``settings`` are what it was made from, as in its file; ``dt`` is its sample time in seconds.
    After every sample ``model`` is the estimate, ``memory`` what the input has left in it, and
    ``command`` its inverse.
    """

    dt: float
    settings: dict[str, Any]

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Names of the m parameters."""

    @property
    @abstractmethod
    def parameters(self) -> Array:
        """The estimate, shape (m,)."""

    @property
    @abstractmethod
    def covariance(self) -> Array:
        """Covariance of the estimate, shape (m, m); 0 for what is held."""

    @property
    def standard_errors(self) -> Array:
        """Standard errors of the estimate, shape (m,); 0 for what is held."""
        return np.sqrt(np.diag(self.covariance))

    @property
    @abstractmethod
    def model(self) -> Operator:
        """The estimate as a model, with the memory that the input has left if it can say it."""

    @property
    def memory(self) -> Array:
        """The state from which ``model`` goes on where the input has left it, a copy.

        ``estimator.model.stepper(estimator.memory)`` and ``model.run(u, estimator.memory)`` go on.
        It is the initial state of ``model`` where the constants of that say it.
        """
        return self.model.initial_state()

    @property
    @abstractmethod
    def error(self) -> float:
        """Measured less predicted output of the last sample used, output units."""

    @property
    @abstractmethod
    def noise(self) -> float:
        """Estimated standard deviation of the output's noise, output units."""

    @property
    @abstractmethod
    def counts(self) -> dict[str, int]:
        """Samples ``"used"``, ``"skipped"`` as not finite, and ``"refused"`` for an overflow."""

    @property
    @abstractmethod
    def innovation(self) -> Innovation:
        """What the estimate leaves unexplained, and whether that can be noise."""

    @property
    def at_bound(self) -> str:
        """Which bound stops the estimate from what the samples ask for; empty if none does."""
        return ""

    @property
    def knowledge(self) -> Knowledge:
        """What is known of each parameter: a band, or why it is not determined."""
        innovation = self.innovation
        doubt = (
            ()
            if innovation.consistent
            else (f"{innovation}; the bands are then too narrow, since they take errors for noise",)
        )
        return knowledge_from(self.names, self.parameters, self.standard_errors, {}, doubts=doubt)

    @abstractmethod
    def update(self, u: float, y: float) -> bool:
        """Take in one sample.

        Parameters
        ----------
        u, y
            Input and measured output; one that is not finite is skipped and counted. Where only
            the output is missing, let the memory ``follow`` the input.

        Returns
        -------
        bool
            Whether the sample was used.
        """

    def run(self, record: Record, every: int = 1) -> Trajectory:
        """Take in a whole record.

        Parameters
        ----------
        record
            Of the estimator's sample time.
        every
            Keep the estimate after every so many samples.

        Returns
        -------
        Trajectory

        Raises
        ------
        InputError
            If it is no record or its sample time is another one, or ``every`` is not a whole number
            above 0.
        """
        u, y, time = samples_of(record, self.dt, every)
        shape = (time.size, len(self.names))
        values, errors, error = np.empty(shape), np.empty(shape), np.zeros(u.size)
        for k, (u_k, y_k) in enumerate(zip(u.tolist(), y.tolist(), strict=True), 1):
            if self.update(u_k, y_k):
                error[k - 1] = self.error
            if k % every == 0:
                values[k // every - 1] = self.parameters
                errors[k // every - 1] = self.standard_errors
        return Trajectory(time, self.names, values, errors, error)

    @abstractmethod
    def follow(self, u: ArrayLike) -> None:
        """Let the memory follow inputs whose outputs were not measured; learns nothing.

        Parameters
        ----------
        u
            Shape (N,), what the actuator has passed, finite.

        Raises
        ------
        InputError
            If it is not a finite vector.
        """

    @abstractmethod
    def command(self, y_ref: float) -> float:
        """Give the input for which the present estimate predicts a wanted output; learns nothing.

        Parameters
        ----------
        y_ref
            Wanted output; NaN gives NaN.

        Returns
        -------
        float

        Raises
        ------
        NotInvertibleError
            If models of this family have no exact causal inverse.
        """

    @abstractmethod
    def restart(self, model: Operator | None = None) -> None:
        """Forget what was learnt, keep the memory of the input, and widen all variances again.

        Parameters
        ----------
        model
            Parameters to go on from, of a model like the one at the start; those if left out.

        Raises
        ------
        InputError
            If it is a model of another structure, or starts out of bounds.
        """

    @abstractmethod
    def frozen(self) -> Self:
        """Give an estimator that starts from this estimate and its memory and learns nothing.

        It predicts, follows and commands with the constants it has, and ``restart(model)`` gives it
        others.
        """

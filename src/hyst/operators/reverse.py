"""The derivative of an operator from its output back to its input and its parameters."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_signal, as_state
from hyst.errors import InputError

Array = NDArray[np.float64]


class Reverse(ABC):
    """What the engine goes back through."""

    @abstractmethod
    def initial_state(self) -> Array:
        """Give the state before the first sample, shape (n,), a fresh array."""

    @property
    @abstractmethod
    def _chain(self) -> _engine.Chain: ...

    @final
    def vjp(
        self, u: ArrayLike, cotangent: ArrayLike, state: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Give the product of a vector with the derivatives by the input and by the parameters.

        ``c' dy/du`` and ``c' dy/dtheta`` in reverse mode: where c is the gradient of a loss by the
        output, these are its gradients by the input and by the parameters. No Jacobian is stored,
        and the cost does not grow with the number of parameters beyond that of the model.

        The output need not have a derivative everywhere: where a play begins to move it has two
        one-sided ones. The derivative given is that of the branch which the step takes, of a play
        that starts to move or stops on a sample as ``jacobian`` has it. The initial state depends
        on neither.

        Parameters
        ----------
        u
            Shape (N,) or (batch, N), finite, N >= 1.
        cotangent
            The vector c, in the shape of ``u``, finite.
        state
            Shape (n,) or (batch, n), float64; the initial state if left out.

        Returns
        -------
        by_u : numpy.ndarray
            In the shape of ``u``.
        by_parameters : numpy.ndarray
            Shape (m,) or (batch, m), m = ``len(self.parameters())``.

        Raises
        ------
        InputError
            If ``u``, ``cotangent`` or ``state`` cannot be used.

        Examples
        --------
        >>> from hyst.operators import Play
        >>> by_u, by_r = Play(0.5).vjp([1.0, 2.0, 1.8], [0.0, 0.0, 1.0])
        >>> by_u, by_r  # at the last sample the play rests where the one before pushed it
        (array([0., 1., 0.]), array([-1.]))
        """
        signal, given = as_signal(u), as_signal(cotangent, "cotangent")
        if given.shape != signal.shape:
            raise InputError(
                f"u has shape {signal.shape} and cotangent {given.shape}; give one number for each "
                "sample of u"
            )
        batch = None if signal.ndim == 1 else signal.shape[0]
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, batch)
        rows = np.atleast_2d(signal)
        by_u = np.array(given, ndmin=2)
        by_parameters = np.empty((len(rows), self._chain.parameter_count))
        self._chain.reverse(memory, rows, by_u, by_parameters)
        return (by_u, by_parameters) if batch is not None else (by_u[0], by_parameters[0])

"""The last samples, and the memory the model had before them, with its derivatives."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.operators import Operator

Array = NDArray[np.float64]


@final
class Window:
    """The last samples of a record, along which outputs and derivatives are those of a model.

    The memory before the first sample is kept with its derivatives by all constants, as the kernel
    has carried them along the whole past. So the past moves with the constants: of constants theta
    the memory is ``state + tangents (theta - theta_at)``, to second order.

    Parameters
    ----------
    model
        The operator.
    room
        Most samples.
    """

    def __init__(self, model: Operator, room: int) -> None:
        self._chain = _engine.Chain(model.stages())
        self.state = model.initial_state()
        """Shape (n,), before the first sample."""
        self.theta_at = model.parameters().values.copy()
        """Shape (m,), the constants for which it is that."""
        self.tangents = np.zeros((self.state.size, self.theta_at.size))
        """Shape (n, m), its derivatives."""
        self.u, self.y = np.zeros(room), np.zeros(room)
        self.told = np.zeros(room)
        """1 where the output was measured, else 0."""
        self.count = 0

    def add(self, u: float, y: float, told: float) -> None:
        """Take in a sample behind the others."""
        k = self.count
        self.u[k], self.y[k], self.told[k] = u, y, told
        self.count = k + 1

    def memory_for(self, theta: Array) -> Array:
        """Give the memory before the first sample for constants ``theta``."""
        return np.ascontiguousarray(self.state + self.tangents @ (theta - self.theta_at))

    def outputs(self, theta: Array) -> tuple[Array, Array]:
        """Give the model's output, and its memory after it; NaN from a sample that overflows."""
        memory, count = self.memory_for(theta), self.count
        self._chain.set_parameters(theta)
        y = np.full((1, count), np.nan)
        state = memory.reshape(1, -1)
        if count:
            bad = self._chain.run(state, self.u[:count].reshape(1, -1), y, "auto", 1)
            if bad >= 0:
                y[0, bad:] = np.nan
        return y[0], state[0]

    def sensitivity(self, theta: Array) -> tuple[Array, Array]:
        """Give the model's output and its derivative by the constants, shape (N, m)."""
        y, jacobian, _, _ = self._carried(theta, self.count)
        return y, jacobian

    def drop(self, theta: Array, count: int) -> tuple[Array, Array]:
        """Leave the first ``count`` samples behind, of which it gives output and derivative."""
        y, jacobian, state, tangents = self._carried(theta, count)
        self.state, self.tangents, self.theta_at = state, tangents, theta.copy()
        rest = self.count - count
        for each in (self.u, self.y, self.told):
            each[:rest] = each[count : self.count]
        self.count = rest
        return y, jacobian

    def _carried(self, theta: Array, count: int) -> tuple[Array, Array, Array, Array]:
        state, tangents = self.memory_for(theta), self.tangents.copy()
        self._chain.set_parameters(theta)
        y, jacobian = self.u[:count].copy(), np.zeros((count, theta.size))
        self._chain.carry_jacobian(state, tangents, y, jacobian)
        return y, jacobian, state, tangents

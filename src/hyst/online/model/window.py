"""The last samples, and the memory the model had before them, with its derivatives."""

from __future__ import annotations

from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.online.model.turns import kept_turns
from hyst.operators import Operator
from hyst.operators.traits import Degree

Array = NDArray[np.float64]


@final
class Window:
    """The last samples of a record, along which outputs and derivatives are those of a model.

    The memory before the first sample moves with the constants. Where it is one of return points,
    it is run through the turning points that are left of the whole past. Elsewhere it is kept with
    its derivatives by all constants, as the kernel has carried them along the past: of constants
    theta it is ``state + tangents (theta - theta_at)``, to second order.

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
        traits = model.traits()
        self.recalls = traits.return_point_memory and traits.rate_independent != Degree.NO
        """Whether turning points tell the memory, for any constants; else derivatives do."""
        self.turns = np.zeros(0)
        """What is kept of the inputs before the first sample, from the memory ``state`` on."""
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
        if not self.recalls:
            return np.ascontiguousarray(self.state + self.tangents @ (theta - self.theta_at))
        return self._run(theta, self.turns)[1]

    def outputs(self, theta: Array) -> tuple[Array, Array]:
        """Give the model's output, and its memory after it; NaN from a sample that overflows."""
        y, state = self._run(theta, np.concatenate([self.turns, self.u[: self.count]]))
        return y[self.turns.size :], state

    def sensitivity(self, theta: Array) -> tuple[Array, Array]:
        """Give the model's output and its derivative by the constants, shape (N, m)."""
        y, jacobian, _, _ = self._carried(theta, self.count)
        return y, jacobian

    def drop(self, theta: Array, count: int) -> tuple[Array, Array]:
        """Leave the first ``count`` samples behind, of which it gives output and derivative."""
        y, jacobian, state, tangents = self._carried(theta, count)
        if self.recalls:
            self.turns = kept_turns([*self.turns.tolist(), *self.u[:count].tolist()])
        else:
            self.state, self.tangents, self.theta_at = state, tangents, theta.copy()
        rest = self.count - count
        for each in (self.u, self.y, self.told):
            each[:rest] = each[count : self.count]
        self.count = rest
        return y, jacobian

    def begin_at(self, state: Array) -> None:
        """Begin with a memory whose derivatives are not known."""
        self.state, self.tangents = state, np.zeros_like(self.tangents)
        self.turns, self.recalls, self.count = np.zeros(0), False, 0

    def go_on_from(self, other: Window) -> None:
        """Begin where another window of the same model is."""
        self.state, self.tangents = other.state.copy(), other.tangents.copy()
        self.theta_at, self.turns = other.theta_at.copy(), other.turns.copy()
        self.recalls, self.count = other.recalls, other.count
        for to, of in ((self.u, other.u), (self.y, other.y), (self.told, other.told)):
            to[:] = of

    def _run(self, theta: Array, u: Array) -> tuple[Array, Array]:
        start = self.state if self.recalls else self.memory_for(theta)
        self._chain.set_parameters(theta)
        y, state = np.full((1, u.size), np.nan), start.reshape(1, -1).copy()
        if u.size:
            bad = self._chain.run(state, np.ascontiguousarray(u).reshape(1, -1), y, "auto", 1)
            if bad >= 0:
                y[0, bad:] = np.nan
        return y[0], state[0]

    def _carried(self, theta: Array, count: int) -> tuple[Array, Array, Array, Array]:
        begin = self.turns.size
        state = self.state.copy() if self.recalls else self.memory_for(theta)
        tangents = self.tangents.copy()
        self._chain.set_parameters(theta)
        y = np.concatenate([self.turns, self.u[:count]])
        jacobian = np.zeros((y.size, theta.size))
        self._chain.carry_jacobian(state, tangents, y, jacobian)
        return y[begin:], jacobian[begin:], state, tangents

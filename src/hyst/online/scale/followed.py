"""A model and its inverse, both with the memory that the input has left."""

from __future__ import annotations

import math
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator

Array = NDArray[np.float64]


@final
class Followed:
    """A model that takes in what the actuator is given, and its inverse beside it.

    The exact inverse, fed with what the model gives, repeats the input; so its memory always
    belongs to the input that was applied, whoever commanded it.

    Parameters
    ----------
    model
        Any operator; one without exact inverse is followed as well.
    """

    def __init__(self, model: Operator) -> None:
        self.model = model
        self.refusal = ""
        """Why there is no exact inverse; empty if there is one."""
        self._back = model
        try:
            self._back = model.inverse()
        except NotInvertibleError as error:
            self.refusal = str(error)
        self._forward, self._inverse = model.stepper(), self._back.stepper()
        self._before = np.empty_like(self._inverse.state)

    @property
    def length(self) -> int:
        """Entries of ``memory``."""
        return self._forward.state.size + (0 if self.refusal else self._inverse.state.size)

    @property
    def memory(self) -> Array:
        """That of the model, then that of the inverse if there is one; a copy."""
        if self.refusal:
            return self._forward.state.copy()
        return np.concatenate([self._forward.state, self._inverse.state])

    @memory.setter
    def memory(self, memory: Array) -> None:
        count = self._forward.state.size
        self._forward.state[:] = memory[:count]
        if not self.refusal:
            self._inverse.state[:] = memory[count:]

    @property
    def model_memory(self) -> Array:
        """That of the model alone; a copy."""
        return self._forward.state.copy()

    def step(self, u: float) -> float:
        """Take in a finite input; NaN if the model overflows at it."""
        w = self._forward(u)
        if self._forward.fault:
            self._forward.clear_fault()
            return math.nan
        if not self.refusal:
            self._inverse(w)
            self._inverse.clear_fault()
        return w

    def run(self, u: Array) -> Array:
        """Take in a finite record at once, with the numbers of ``step``."""
        try:
            w, after = self.model.run(u, self._forward.state, engine="loop")
            if not self.refusal:
                self._inverse.state[:] = self._back.run(w, self._inverse.state, engine="loop")[1]
        except InputError:  # it overflows at a sample, where one step after the other goes on
            return np.array([self.step(each) for each in u.tolist()])
        self._forward.state[:] = after
        return w

    def input_for(self, w: float) -> float:
        """Give the input at which the model would give w next; NaN if none would.

        Raises
        ------
        NotInvertibleError
            If there is no exact inverse.
        """
        if self.refusal:
            raise NotInvertibleError(
                f"no command can be given, but the estimate goes on: {self.refusal}"
            )
        state = self._inverse.state
        self._before[:] = state
        u = self._inverse(w)
        state[:] = self._before
        if self._inverse.fault:
            self._inverse.clear_fault()
            return math.nan
        return u

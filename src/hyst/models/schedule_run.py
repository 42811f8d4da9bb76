"""What runs with a second signal: records and samples of input and signal, side by side."""

from __future__ import annotations

import functools
import warnings
from abc import abstractmethod
from typing import NamedTuple, Protocol, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_state, finite_array, finite_vector, refuse_sample
from hyst.errors import InputError
from hyst.operators.description import Described
from hyst.operators.stage import Stage

Array = NDArray[np.float64]


class ScheduledRun(NamedTuple):
    """What a run with a second signal gives.

    Parameters
    ----------
    y
        Shape (N,), the output.
    state
        Shape (n,), the memory after the last sample.
    held
        At how many samples the second signal was outside the schedule, so that the constants were
        held at its end.
    """

    y: Array
    state: Array
    held: int


class ScheduledStepper(Protocol):
    """One sample of input and second signal in, one sample out: ``y = step(u, s)``.

    A sample of which either is not finite repeats the last output, leaves the state as it is and
    raises ``fault``; a second signal outside the schedule raises ``outside``, and the constants are
    held at the end. Both stay up until ``clear_fault()``. ``state`` is the live array.
    """

    @property
    def state(self) -> NDArray[np.float64]:
        """Shape (n,), live."""

    @property
    def fault(self) -> bool:
        """True since the first sample that was not finite."""

    @property
    def outside(self) -> bool:
        """True since the second signal was first outside the schedule."""

    def clear_fault(self) -> None:
        """Lower both flags."""

    def __call__(self, u: float, s: float, /) -> float:
        """One sample."""


class ScheduledSystem(Described):
    """A causal system whose constants follow a second signal; its memory is kept meanwhile."""

    values: Array
    name: str

    @abstractmethod
    def initial_state(self) -> Array:
        """Give the state before the first sample, shape (n,), a fresh array."""

    @property
    @abstractmethod
    def knot_stages(self) -> tuple[tuple[Stage, ...], ...]:
        """The stages at each value of the schedule, which differ in their constants alone.

        Raises
        ------
        InputError
            If the memory of a stage would mean nothing with other constants.
        """

    @final
    def outside(self, s: ArrayLike) -> NDArray[np.bool_]:
        """Tell where the second signal is outside the schedule, so that constants are held.

        Parameters
        ----------
        s
            Any shape.

        Returns
        -------
        numpy.ndarray
            In the shape of ``s``.
        """
        given = finite_array(s, self.name)
        return np.asarray((given < self.values[0]) | (given > self.values[-1]))

    @final
    def run(self, u: ArrayLike, s: ArrayLike, state: ArrayLike | None = None) -> ScheduledRun:
        """Give the output for a record of input and second signal.

        Running two halves one after the other gives the same bits as running the whole.

        Parameters
        ----------
        u
            Shape (N,), finite, N >= 1.
        s
            The second signal: shape (N,), or a number where it does not change; finite.
        state
            Shape (n,), float64; the initial state if left out. It is not changed.

        Returns
        -------
        ScheduledRun
            y, state, and how many samples were held at an end of the schedule.

        Raises
        ------
        InputError
            If a signal or the state cannot be used, a sample overflows on its way (the first is
            named), or the memory of a stage would mean nothing with other constants.
        """
        signal = finite_vector(u, "u")
        second = finite_array(s, self.name)
        if second.ndim == 0:
            second = np.full(signal.size, second)
        if second.shape != signal.shape:
            raise InputError(
                f"{self.name} has shape {second.shape} and the input {signal.shape}; give one "
                "value for each sample, or a number"
            )
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._moving.state_length, None)[0]
        y = np.empty(signal.size)
        bad, held = self._moving.run(memory, np.ascontiguousarray(signal), second.copy(), y)
        if bad >= 0:
            refuse_sample(signal, bad, "u")
        return ScheduledRun(y, memory, held)

    @final
    def __call__(self, u: ArrayLike, s: ArrayLike) -> Array:
        """Give the output for a record from the initial state; warns where constants are held.

        Parameters
        ----------
        u, s
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            Shape (N,).

        Raises
        ------
        InputError
            As ``run``.
        """
        y, _, held = self.run(u, s)
        if held:
            warnings.warn(
                f"at {held} of {y.size} samples {self.name} is outside {self.values[0]:.6g} to "
                f"{self.values[-1]:.6g}, where the model is known; its constants are held at the "
                "end there",
                stacklevel=2,
            )
        return y

    @final
    def stepper(self, state: ArrayLike | None = None) -> ScheduledStepper:
        """Give a callable that takes input and second signal sample by sample, as ``run`` does.

        Parameters
        ----------
        state
            Shape (n,), float64; the initial state if left out. It is copied.

        Returns
        -------
        ScheduledStepper
            ``step(u, s) -> y``, with ``state``, ``fault``, ``outside`` and ``clear_fault()``.

        Raises
        ------
        InputError
            As ``run``.
        """
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._moving.state_length, None)[0]
        return _engine.MovingStepper(self.values.tolist(), self.knot_stages, memory)

    @functools.cached_property
    def _moving(self) -> _engine.Moving:
        return _engine.Moving(self.values.tolist(), self.knot_stages)

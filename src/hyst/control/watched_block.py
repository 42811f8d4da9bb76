"""What a sampled block can tell beside its drive."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.control.block_constants import refuse_overflow_at, two_records
from hyst.control.saved_block import SavedBlock
from hyst.errors import InputError

Array = NDArray[np.float64]


class WatchedBlock(SavedBlock, ABC):
    """Signals of ``TrackingController`` that are not its output."""

    @property
    @abstractmethod
    def compiled(self) -> _engine.TrackingController:
        """The block in the engine."""

    @abstractmethod
    def _checked_state(self, state: ArrayLike | None) -> Array:
        """Give a copy of the state, or the initial one."""

    def estimate(self, y_ref: ArrayLike, y: ArrayLike, state: ArrayLike | None = None) -> Array:
        """Give what the observer estimates, d_hat, for the records and the state of ``run``.

        Parameters
        ----------
        y_ref, y, state
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            Shape (N,), in units of v; zeros without an observer.

        Raises
        ------
        InputError
            As ``run``, or if E and F are not known.
        """
        if self.E is None or self.F is None:
            raise InputError("E and F were not given, so the estimate is not known; give both")
        memory = self._checked_state(state)
        if self.W is not None:
            return self._told(y_ref, y, memory)[1]
        return self._linear(y_ref, y, memory, self.E, self.F)

    def applied(self, y_ref: ArrayLike, y: ArrayLike, state: ArrayLike | None = None) -> Array:
        """Give the v that belongs to the drive applied, for the records and the state of ``run``.

        Parameters
        ----------
        y_ref, y, state
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            Shape (N,); without limits, or within them, the v that is wanted.

        Raises
        ------
        InputError
            As ``run``.
        """
        memory = self._checked_state(state)
        if self.W is not None:
            return self._told(y_ref, y, memory)[0]
        return self._linear(y_ref, y, memory, self.C, self.D)

    def _linear(self, y_ref: ArrayLike, y: ArrayLike, memory: Array, C: Array, D: Array) -> Array:
        """Give ``C x + D [y_ref, y]`` without limits."""
        signals, x = two_records(y_ref, y), memory[: C.size].copy()
        told = np.empty_like(signals[0])
        block = in_engine(self.A, self.B, C, D, _engine.Chain(()))
        refuse_overflow_at(block.run(x, *signals, told))
        return told

    def _told(self, y_ref: ArrayLike, y: ArrayLike, memory: Array) -> tuple[Array, Array]:
        signals = two_records(y_ref, y)
        E, F = (self.C, self.D) if self.E is None or self.F is None else (self.E, self.F)
        v, d_hat = np.empty_like(signals[0]), np.empty_like(signals[0])
        into = float(F[0]), float(F[1]), self.G
        refuse_overflow_at(self.compiled.tell(memory, *signals, E.tolist(), *into, v, d_hat))
        return v, d_hat


def in_engine(
    A: Array, B: Array, C: Array, D: Array, inverse: _engine.Chain
) -> _engine.TrackingController:
    """Give a linear part and an inverse as the engine takes them.

    Parameters
    ----------
    A, B, C, D
        As ``TrackingController`` has them.
    inverse
        The chain from v to the drive.
    """
    columns, b = A.T.ravel().tolist(), B.T.ravel().tolist()
    return _engine.TrackingController(columns, b, C.tolist(), float(D[0]), float(D[1]), inverse)

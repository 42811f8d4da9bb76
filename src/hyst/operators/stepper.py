"""The callable that takes one sample at a time."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class Stepper(Protocol):
    """One sample in, one sample out: ``y = step(u)``.

    A sample that is not finite repeats the last output, leaves the state as it is and raises
    ``fault``, which stays up until ``clear_fault()``. Before the first sample the output to repeat
    is 0. ``state`` is the live array: copy it to save it, assign into it to restore it.
    """

    @property
    def state(self) -> NDArray[np.float64]:
        """Shape (n,), live."""

    @property
    def fault(self) -> bool:
        """True since the first sample that was not finite."""

    def clear_fault(self) -> None:
        """Lower the fault flag."""

    def __call__(self, u: float, /) -> float:
        """One sample."""

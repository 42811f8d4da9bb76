"""What play and stop have in common: one threshold, and a play's output as state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_threshold
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries


@dataclass(frozen=True, eq=False)
class ThresholdOperator(Operator):
    """An operator of one threshold r whose state is the output of a play, at first z0."""

    r: float
    z0: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "r", as_threshold(self.r))
        # -0.0 becomes 0.0, since a dictionary leaves out a memory of zero.
        object.__setattr__(self, "z0", as_number(self.z0, "z0") + 0.0)

    def initial_state(self) -> NDArray[np.float64]:
        """Give the initial play output, shape (1,)."""
        return np.array([self.z0])

    def parameters(self) -> Parameters:
        """Give the threshold."""
        return Parameters(
            values=np.array([self.r]), names=("r",), lower=np.zeros(1), upper=np.full(1, np.inf)
        )

    def with_parameters(self, theta: Sequence[float] | NDArray[np.float64]) -> Self:
        """Give the operator with another threshold."""
        return type(self)(float(as_parameter_vector(theta, 1)[0]), self.z0)

    def to_dict(self) -> dict[str, Any]:
        """Give kind, threshold and, where there is one, the initial memory."""
        memory = {"z0": self.z0} if self.z0 != 0.0 else {}
        return {"kind": self.kind, "r": self.r, **memory}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("r",), optional=("z0",)))

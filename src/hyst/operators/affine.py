"""Gain and offset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import refuse_overflow
from hyst.checks.numbers import as_number
from hyst.errors import NotInvertibleError
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.portrait import NOTHING, Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits


@register
@final
@dataclass(frozen=True, eq=False)
class Affine(Operator):
    """Gain and offset: ``y = gain u + offset``.

    Parameters
    ----------
    gain
        Output units per input unit.
    offset
        In output units.

    Raises
    ------
    InputError
        If a constant is not a finite number.

    Examples
    --------
    >>> Affine(2.0, 1.0)([0.0, 3.0])
    array([1., 7.])
    """

    gain: float
    offset: float = 0.0

    kind = "affine"
    is_map = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "gain", as_number(self.gain, "gain"))
        object.__setattr__(self, "offset", as_number(self.offset, "offset"))

    def traits(self) -> Traits:
        """Give the traits of a straight line."""
        return Traits(
            memoryless=True,
            rate_independent=Degree.EXACTLY,
            return_point_memory=True,
            congruent_loops=True,
            monotone=self.gain >= 0.0,
            invertible=self.is_invertible,
        )

    def initial_state(self) -> NDArray[np.float64]:
        """Give an empty array: there is no memory."""
        return np.empty(0)

    def exact_inverse(self) -> Affine:
        """Give ``u = (y - offset) / gain``.

        Raises
        ------
        NotInvertibleError
            If the gain is zero, or so small that the inverse overflows.
        """
        if self.gain == 0.0:
            raise NotInvertibleError("gain is 0: every input gives the same output")
        with np.errstate(all="ignore"):
            gain, offset = np.array([1.0, -self.offset]) / self.gain
        refuse_overflow(gain, offset)
        return Affine(float(gain), float(offset))

    def parameters(self) -> Parameters:
        """Give gain and offset."""
        return Parameters(
            values=np.array([self.gain, self.offset]),
            names=("gain", "offset"),
            lower=np.full(2, -np.inf),
            upper=np.full(2, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | NDArray[np.float64]) -> Affine:
        """Give another line."""
        gain, offset = as_parameter_vector(theta, 2)
        return Affine(float(gain), float(offset))

    def parameter_scales(self, input_scale: float, output_scale: float) -> NDArray[np.float64]:
        """Give the factors of gain and offset."""
        return np.array([output_scale / input_scale, output_scale])

    def keeps_unit(self) -> bool:
        """Tell whether the gain is 1 or -1."""
        return abs(self.gain) == 1.0

    def portrait(self) -> Portrait:
        """Show nothing: a line is seen in the numbers."""
        return NOTHING

    def lipschitz_constant(self) -> float:
        """Give the absolute gain."""
        return abs(self.gain)

    def to_dict(self) -> dict[str, Any]:
        """Give kind, gain and offset."""
        return {"kind": self.kind, "gain": self.gain, "offset": self.offset}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Affine:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("gain", "offset")))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("affine", (self.gain, self.offset)),)

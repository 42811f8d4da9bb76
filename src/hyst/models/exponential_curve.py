"""A loading curve whose slope goes from one value to another as an exponential does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number, as_positive
from hyst.errors import InputError
from hyst.models.loading_curve import InverseCurve, LoadingCurve, ReversalMemory, register_curve
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))


@final
@dataclass(frozen=True)
class ExponentialCurve(LoadingCurve):
    """Exponential: ``f(x) = c x - d b (1 - exp(-x / b))``, whose slope goes from c - d to c.

    From a reversal on, the slope over the way p from there is ``c - d exp(-p / (2 b))``. d > 0: the
    loop stiffens from c - d on and ends as a line; d < 0: it softens. c = 0 and d < 0: it
    saturates at ``|d| b``, as parallel elastic-plastic elements whose ways to slip are spread
    exponentially.

    Parameters
    ----------
    c
        Slope far out, >= 0, output units per input unit.
    d
        By how much the slope grows, <= c, of either sign.
    b
        Way over which it does, > 0, input units.

    Raises
    ------
    InputError
        If a constant is not finite or out of its range, or c and d are both 0.

    Notes
    -----
    The cousin, with nested memory, of Dahl's friction of n = 1, whose branches are exponentials.

    Examples
    --------
    >>> ExponentialCurve(c=0.0, d=-1.0, b=1.0)([0.0, 1.0, 100.0]).round(6)
    array([0.      , 0.632121, 1.      ])
    """

    c: float
    d: float
    b: float

    kind = "exponential"

    def __post_init__(self) -> None:
        for name in ("c", "d"):
            object.__setattr__(self, name, as_number(getattr(self, name), name))
        object.__setattr__(self, "b", as_positive(self.b, "b"))
        if self.c < 0.0:
            raise InputError(
                f"c is {self.c:.6g}; it is the slope far out, which must not be negative"
            )
        if self.d > self.c:
            raise InputError(
                f"d is {self.d:.6g}, more than c = {self.c:.6g}; the slope at 0, c - d, must not "
                "be negative"
            )
        if self.c == 0.0 and self.d == 0.0:
            raise InputError("c and d are 0, so the output would never move; give one of them")

    def __call__(self, x: ArrayLike) -> Array:
        """Give f(x), odd, in the shape of x."""
        values = np.asarray(x, dtype=np.float64)
        t = np.abs(values) / self.b
        f = self.b * (self.c * t + self.d * np.expm1(-t))
        return np.asarray(np.copysign(f, values))

    def inverse(self) -> LoadingCurve:
        """Give the inverse function, solved point by point; an infinity where f does not come."""
        return InverseCurve(self)

    def extreme_slopes(self) -> Array:
        """Give f' at 0 and far out."""
        return np.array([self.c - self.d, self.c])

    @property
    def is_straight(self) -> bool:
        """Whether d is 0."""
        return self.d == 0.0

    def parameters(self) -> Parameters:
        """Give c, d, b."""
        return Parameters(
            values=np.array([self.c, self.d, self.b]),
            names=("c", "d", "b"),
            lower=np.array([0.0, -np.inf, _SMALLEST]),
            upper=np.full(3, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> ExponentialCurve:
        """Give another exponential."""
        return ExponentialCurve(*as_parameter_vector(theta, 3).tolist())

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the constants with d at most c."""
        return np.array([theta[0], min(theta[1], theta[0]), theta[2]])

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of c, d and b."""
        ratio = output_scale / input_scale
        return np.array([ratio, ratio, input_scale])

    def to_dict(self) -> dict[str, Any]:
        """Give kind, c, d and b."""
        return {"kind": self.kind, "c": self.c, "d": self.d, "b": self.b}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> ExponentialCurve:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("c", "d", "b")))

    def stage(self, memory: ReversalMemory, inverse: bool) -> Stage:
        """Give the stage of this curve with a ``memory`` of reversals, or of its ``inverse``."""
        return memory.stage("exponential", (self.c, self.d, self.b), inverse)


register_curve(ExponentialCurve)

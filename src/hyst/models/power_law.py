"""The power law as a loading curve: Ramberg and Osgood's skeleton."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number
from hyst.errors import InputError
from hyst.models.loading_curve import InverseCurve, LoadingCurve, ReversalMemory, register_curve
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))


@final
@dataclass(frozen=True)
class PowerLaw(LoadingCurve):
    """Power law: ``f(x) = c1 x + 2^c3 c2 x^(c3 + 1) / (c3 + 1)``.

    From a reversal on, the output moves by ``2 f(p / 2)``, whose slope over the way p from there is
    ``M(p) = c1 + c2 p^c3`` (S3 eq. 6).

    Parameters
    ----------
    c1, c2
        Output units per input unit, and that per input unit to the power c3; >= 0, not both 0.
        A negative c2 would turn the slope negative far out.
    c3
        Larger than -1. Positive: the curve stiffens from c1 on. Between -1 and 0: it softens from
        an infinite slope towards c1, and f is still finite.

    Raises
    ------
    InputError
        If a constant is not finite or out of its range.

    Notes
    -----
    S3 eqs. 2, 3 and 6. The first loading has the coefficient ``2^c3 c2``, not c2.

    Examples
    --------
    >>> PowerLaw(1.0, 1.0, 1.0)([0.0, 1.0, 2.0])
    array([0., 2., 6.])
    """

    c1: float
    c2: float
    c3: float

    kind = "power-law"

    def __post_init__(self) -> None:
        for name in ("c1", "c2", "c3"):
            object.__setattr__(self, name, as_number(getattr(self, name), name))
        for name in ("c1", "c2"):
            if getattr(self, name) < 0.0:
                raise InputError(
                    f"{name} is {getattr(self, name):.6g}; the slope c1 + c2 p^c3 must not turn "
                    "negative, so give 0 or more"
                )
        if self.c1 == 0.0 and self.c2 == 0.0:
            raise InputError("c1 and c2 are 0, so the output would never move; give one above 0")
        if self.c3 <= -1.0:
            raise InputError(
                f"c3 is {self.c3:.6g}; the loading curve is finite for c3 above -1 only"
            )

    def __call__(self, x: ArrayLike) -> Array:
        """Give f(x), odd, in the shape of x."""
        values = np.asarray(x, dtype=np.float64)
        along = np.abs(values)
        exponent = self.c3 + 1.0
        raised = 2.0**self.c3 * self.c2 / exponent * along**exponent
        return np.asarray(np.copysign(self.c1 * along + raised, values))

    def inverse(self) -> LoadingCurve:
        """Give the inverse function, solved point by point in at most 6 power evaluations."""
        return InverseCurve(self)

    def extreme_slopes(self) -> Array:
        """Give f' at 0 and far out."""
        if self.is_straight:
            return np.full(1, self.c1 if self.c2 == 0.0 else self.c1 + self.c2)
        ends = np.array([self.c1, np.inf])
        return ends if self.c3 > 0.0 else ends[::-1]

    @property
    def is_straight(self) -> bool:
        """Whether c2 or c3 is 0."""
        return self.c2 == 0.0 or self.c3 == 0.0

    def parameters(self) -> Parameters:
        """Give c1, c2, c3."""
        return Parameters(
            values=np.array([self.c1, self.c2, self.c3]),
            names=("c1", "c2", "c3"),
            lower=np.array([min(self.c1, _SMALLEST), 0.0, float(np.nextafter(-1.0, 0.0))]),
            upper=np.full(3, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> PowerLaw:
        """Give another power law."""
        return PowerLaw(*as_parameter_vector(theta, 3).tolist())

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of c1, c2 and c3; that of c2 depends on c3."""
        ratio = output_scale / input_scale
        return np.array([ratio, ratio * input_scale**-self.c3, 1.0])

    def to_dict(self) -> dict[str, Any]:
        """Give kind, c1, c2 and c3."""
        return {"kind": self.kind, "c1": self.c1, "c2": self.c2, "c3": self.c3}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> PowerLaw:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("c1", "c2", "c3")))

    def stage(self, memory: ReversalMemory, inverse: bool) -> Stage:
        """Give the stage of this curve with a ``memory`` of reversals, or of its ``inverse``."""
        return memory.stage("power-law", (self.c1, self.c2, self.c3), inverse)


register_curve(PowerLaw)

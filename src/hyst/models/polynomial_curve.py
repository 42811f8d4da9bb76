"""A polynomial as a loading curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.errors import InputError
from hyst.models.loading_curve import InverseCurve, LoadingCurve, ReversalMemory, register_curve
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.registry import entries
from hyst.operators.stage import Stage

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, init=False)
class PolynomialCurve(LoadingCurve):
    """Polynomial: ``f(x) = a_1 x + a_2 x^2 + .. + a_n x^n`` for x >= 0, odd beyond.

    Parameters
    ----------
    coefficients
        Shape (n,), n >= 1, ``a_1 .. a_n``, with ``f'`` positive on all x >= 0. The slope may fall
        on the way, as long as it stays positive.

    Raises
    ------
    InputError
        If there is none, one is not finite, or f' is not positive somewhere; the place is named.

    Examples
    --------
    >>> PolynomialCurve([1.0, 0.5])([1.0, -2.0])
    array([ 1.5, -4. ])
    """

    coefficients: Array

    kind = "polynomial"

    def __init__(self, coefficients: ArrayLike) -> None:
        a = as_constants(coefficients, "coefficients")
        if a.size == 0:
            raise InputError("a polynomial needs at least one coefficient, that of x")
        object.__setattr__(self, "coefficients", a)
        places = self._extremes_of_slope()
        slopes = self._slope(places)
        wrong = np.flatnonzero(~(slopes > 0.0))
        if wrong.size:
            i = int(wrong[0])
            raise InputError(
                f"the slope of the polynomial is {slopes[i]:.6g} at {places[i]:.6g}; a loading "
                "curve rises everywhere, so give coefficients whose f' is positive"
            )
        if a[np.flatnonzero(a)[-1]] < 0.0:
            raise InputError(
                f"the highest coefficient is {a[np.flatnonzero(a)[-1]]:.6g}, so the polynomial "
                "falls far out; a loading curve rises everywhere, so make it positive"
            )

    def __call__(self, x: ArrayLike) -> Array:
        """Give f(x), odd, in the shape of x."""
        values = np.asarray(x, dtype=np.float64)
        f = np.polynomial.polynomial.polyval(np.abs(values), np.append(0.0, self.coefficients))
        return np.asarray(np.copysign(f, values))

    def inverse(self) -> LoadingCurve:
        """Give the inverse function, solved point by point inside a bracket."""
        return InverseCurve(self)

    def extreme_slopes(self) -> Array:
        """Give f' at 0, at its extremes, and far out."""
        slopes = self._slope(self._extremes_of_slope())
        return slopes if self.is_straight else np.append(slopes, np.inf)

    @property
    def is_straight(self) -> bool:
        """Whether only the first coefficient is not 0."""
        return not self.coefficients[1:].any()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PolynomialCurve) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash(tuple(self.coefficients.tolist()))

    def parameters(self) -> Parameters:
        """Give the coefficients."""
        n = self.coefficients.size
        free = np.full(n, np.inf)
        return Parameters(self.coefficients, numbered("a", n), -free, free)

    def with_parameters(self, theta: Sequence[float] | Array) -> PolynomialCurve:
        """Give another polynomial of the same degree."""
        return PolynomialCurve(as_parameter_vector(theta, self.coefficients.size))

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the coefficients."""
        return output_scale * input_scale ** -np.arange(1.0, self.coefficients.size + 1.0)

    def to_dict(self) -> dict[str, Any]:
        """Give kind and coefficients."""
        return {"kind": self.kind, "coefficients": self.coefficients.tolist()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> PolynomialCurve:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("coefficients",)))

    def stage(self, memory: ReversalMemory, inverse: bool) -> Stage:
        """Give the stage of this curve with a ``memory`` of reversals, or of its ``inverse``."""
        # A little below the least slope: a bracket must not fail by rounding.
        least = 0.99 * float(self._slope(self._extremes_of_slope()).min())
        return memory.stage(
            "polynomial", tuple(self.coefficients.tolist()), inverse, least_slope=least
        )

    def _slope(self, x: Array) -> Array:
        degree = np.arange(1, self.coefficients.size + 1)
        return np.asarray(np.polynomial.polynomial.polyval(x, degree * self.coefficients))

    def _extremes_of_slope(self) -> Array:
        """0 and the x > 0 at which f' has an extreme, ascending."""
        degree = np.arange(self.coefficients.size + 1)
        second = (degree * (degree - 1.0) * np.append(0.0, self.coefficients))[2:]
        second = np.trim_zeros(second, "b")
        roots = np.polynomial.polynomial.polyroots(second) if second.size > 1 else np.empty(0)
        # A double root may come out with an imaginary part of the root of the rounding.
        real = roots.real[np.abs(roots.imag) <= 1e-6 * (1.0 + np.abs(roots.real))]
        return np.append(0.0, np.sort(real[real > 0.0]))


register_curve(PolynomialCurve)

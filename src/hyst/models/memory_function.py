"""Memory functions M(p): how a memory element's ratio of output to input depends on its past."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_number
from hyst.errors import InputError
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.registry import entries

Array = NDArray[np.float64]
Form = Literal["power-law", "polynomial", "table"]


@final
@dataclass(frozen=True, eq=False, init=False)
class MemoryFunction:
    """A positive function M of the momentum p, made by ``power_law``, ``polynomial`` or ``table``.

    Parameters
    ----------
    form
        ``"power-law"``: ``c1 + c2 |p|^c3``, c1 > 0, c2 >= 0, c3 > 0.
        ``"polynomial"``: ``a_0 + a_1 p + .. + a_n p^n``, positive for every p.
        ``"table"``: linear between the points (knot, value), constant beyond; positive values.
    values
        c1, c2, c3; a_0 .. a_n; or the values of the table.
    knots
        Of the table, strictly ascending.

    Raises
    ------
    InputError
        If the form is unknown, a constant is not finite, knots do not fit, or M is not positive
        everywhere; then where not.

    Examples
    --------
    >>> float(MemoryFunction.table([0.0, 2.0], [1.0, 3.0])(1.0))
    2.0
    """

    form: Form
    values: Array
    knots: Array

    def __init__(self, form: Form, values: ArrayLike, knots: ArrayLike = ()) -> None:
        object.__setattr__(self, "form", form)
        object.__setattr__(self, "values", as_constants(values, "values"))
        object.__setattr__(self, "knots", as_constants(np.asarray(knots, dtype=float), "knots"))
        checks = {
            "power-law": self._check_power_law,
            "polynomial": self._check_polynomial,
            "table": self._check_table,
        }
        if form not in checks:
            raise InputError(f"form is {form!r}; choose 'power-law', 'polynomial' or 'table'")
        if form != "table" and self.knots.size:
            raise InputError(f"a {form} has no knots; leave them out")
        checks[form]()

    @classmethod
    def power_law(cls, c1: float, c2: float, c3: float) -> MemoryFunction:
        """Give ``c1 + c2 |p|^c3`` (S3 eq. 6).

        Parameters
        ----------
        c1, c2, c3
            c1 > 0, c2 >= 0, c3 > 0.

        Returns
        -------
        MemoryFunction
        """
        return cls("power-law", [as_number(c1, "c1"), as_number(c2, "c2"), as_number(c3, "c3")])

    @classmethod
    def polynomial(cls, coefficients: ArrayLike) -> MemoryFunction:
        """Give ``a_0 + a_1 p + .. + a_n p^n``.

        Parameters
        ----------
        coefficients
            Shape (n + 1,); the polynomial is positive for every p.

        Returns
        -------
        MemoryFunction
        """
        return cls("polynomial", coefficients)

    @classmethod
    def table(cls, knots: ArrayLike, values: ArrayLike) -> MemoryFunction:
        """Give the function linear between points and constant beyond them.

        Parameters
        ----------
        knots, values
            Shape (n,), n >= 1; knots strictly ascending, values positive.

        Returns
        -------
        MemoryFunction
        """
        return cls("table", values, knots)

    def __call__(self, p: ArrayLike) -> Array:
        """Give M(p), in the shape of p."""
        momentum = np.asarray(p, dtype=np.float64)
        if self.form == "table":
            return np.asarray(np.interp(momentum, self.knots, self.values))
        if self.form == "polynomial":
            return np.asarray(np.polynomial.polynomial.polyval(momentum, self.values))
        c1, c2, c3 = self.values
        return np.asarray(c1 + c2 * np.abs(momentum) ** c3)

    def parameters(self) -> Parameters:
        """Give the values; the knots of a table stay as they are."""
        count = self.values.size
        tiny, free = np.nextafter(0.0, 1.0), np.full(count, np.inf)
        if self.form == "polynomial":
            return Parameters(self.values, numbered("a", count, 0), -free, free)
        lower = np.full(count, tiny)
        if self.form == "power-law":
            lower[1] = 0.0
            return Parameters(self.values, ("c1", "c2", "c3"), lower, free)
        return Parameters(self.values, numbered("values", count), lower, free)

    def with_parameters(self, theta: Sequence[float] | Array) -> MemoryFunction:
        """Give the same form with other values.

        Parameters
        ----------
        theta
            In the order of ``parameters()``.

        Returns
        -------
        MemoryFunction
        """
        return MemoryFunction(self.form, as_parameter_vector(theta, self.values.size), self.knots)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, MemoryFunction) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash((self.form, *self.values.tolist(), *self.knots.tolist()))

    def to_dict(self) -> dict[str, Any]:
        """Give kind, values and, for a table, knots."""
        knots = {"knots": self.knots.tolist()} if self.form == "table" else {}
        return {"kind": self.form, "values": self.values.tolist(), **knots}

    @classmethod
    def from_dict(cls, data: Any) -> MemoryFunction:
        """Rebuild from ``to_dict()``.

        Parameters
        ----------
        data
            The dictionary.

        Returns
        -------
        MemoryFunction

        Raises
        ------
        InputError
            If it is no dictionary with a kind, or an entry is missing, unknown or not allowed.
        """
        if not isinstance(data, dict) or not isinstance(data.get("kind"), str):
            raise InputError("a memory function is an object with an entry 'kind'; this has none")
        return cls(data["kind"], **entries(data, ("values",), ("knots",)))

    def _check_power_law(self) -> None:
        if self.values.size != 3:
            raise InputError(f"a power law has c1, c2, c3; {self.values.size} values are given")
        c1, c2, c3 = self.values
        if not (c1 > 0.0 and c2 >= 0.0 and c3 > 0.0):
            raise InputError(
                f"c1, c2, c3 are {c1:.6g}, {c2:.6g}, {c3:.6g}; M must be positive and finite for "
                "every p, so give c1 > 0, c2 >= 0, c3 > 0"
            )

    def _check_polynomial(self) -> None:
        a = np.trim_zeros(self.values, "b")
        if a.size == 0 or a[0] <= 0.0:
            raise InputError("the polynomial is not positive at p = 0; give a positive a_0")
        with np.errstate(over="ignore"):
            ratios = a / a[-1]
        if not np.isfinite(ratios).all():
            raise InputError(
                f"values[{a.size - 1}] is {a[-1]:.6g}, too small beside the largest, "
                f"{np.abs(a).max():.6g}, to find the roots; give 0 for it, or choose other units"
            )
        roots = np.polynomial.polynomial.polyroots(ratios) if a.size > 1 else np.empty(0)
        real = roots.real[np.abs(roots.imag) <= 1e-7 * (1.0 + np.abs(roots.real))]
        if real.size:
            raise InputError(
                f"the polynomial is 0 at p = {real[np.argmin(np.abs(real))]:.6g}; M must be "
                "positive for every p"
            )

    def _check_table(self) -> None:
        if self.values.size == 0 or self.values.size != self.knots.size:
            raise InputError(
                f"the table has {self.knots.size} knots and {self.values.size} values; give one or "
                "more of each, as many"
            )
        if self.values.min() <= 0.0:
            i = int(np.argmin(self.values))
            raise InputError(f"values[{i}] is {self.values[i]:.6g}; M must be positive")
        steps = np.diff(self.knots)
        if steps.size and steps.min() <= 0.0:
            i = int(np.argmin(steps)) + 1
            raise InputError(
                f"knots[{i}] = {self.knots[i]:.6g} is not above knots[{i - 1}]; sort the points"
            )

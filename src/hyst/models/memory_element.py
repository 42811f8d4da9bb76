"""Memory elements: resistors, dampers and others whose law depends on what has passed through."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_sample_time
from hyst.errors import InputError
from hyst.models.memory_function import MemoryFunction
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Element(Operator):
    """What a memory element and its inverse have in common: all constants."""

    function: MemoryFunction
    sample_time: float
    momentum: Literal["signed", "absolute"] = "signed"
    reset: Literal["never", "sign-change"] = "never"
    start: float = 0.0
    reset_to: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.function, MemoryFunction):
            raise InputError(
                f"function is of type {type(self.function).__name__}; give a MemoryFunction"
            )
        object.__setattr__(self, "sample_time", as_sample_time(self.sample_time, "sample_time"))
        if self.momentum not in ("signed", "absolute"):
            raise InputError(f"momentum is {self.momentum!r}; choose 'signed' or 'absolute'")
        if self.reset not in ("never", "sign-change"):
            raise InputError(f"reset is {self.reset!r}; choose 'never' or 'sign-change'")
        object.__setattr__(self, "start", as_number(self.start, "start") + 0.0)
        object.__setattr__(self, "reset_to", as_number(self.reset_to, "reset_to") + 0.0)

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def traits(self) -> Traits:
        """Give the traits: an exact inverse, and none of those of hysteresis over its input."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=False,
            invertible=True,
        )

    def initial_state(self) -> Array:
        """Give the momentum and the sign of the last input that was not 0, shape (2,)."""
        return np.array([self.start, 0.0])

    def parameters(self) -> Parameters:
        """Give the values of the memory function."""
        return self.function.parameters()

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the element with another memory function of the same form."""
        return replace(self, function=self.function.with_parameters(theta))

    def lipschitz_constant(self) -> float:
        """Give infinity: the momentum adds up differences of the input without bound."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, memory function and how the momentum is formed."""
        return {
            "kind": self.kind,
            "function": self.function.to_dict(),
            "dt": self.sample_time,
            "momentum": self.momentum,
            "reset": self.reset,
            "start": self.start,
            "reset_to": self.reset_to,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        optional = ("momentum", "reset", "start", "reset_to")
        given = entries(data, ("function", "dt"), optional)
        function = MemoryFunction.from_dict(given.pop("function"))
        return cls(function, given.pop("dt"), **given)

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the output is u."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (
            Stage(
                "memory_element",
                tuple(self.function.values.tolist()),
                fixed={
                    "knots": tuple(self.function.knots.tolist()),
                    "reset_to": (self.reset_to,),
                },
                choices={
                    "inverse": int(self._is_inverse()),
                    "absolute": int(self.momentum == "absolute"),
                    "is_reset": int(self.reset == "sign-change"),
                },
                form=self.function.form,
                dt=self.sample_time,
            ),
        )


@register
@final
@dataclass(frozen=True, eq=False)
class MemoryElement(_Element):
    """Memory element: ``y = M(p) u``, ``dp/dt = g(u)``, with g(u) = u or ``|u|``.

    Parameters
    ----------
    function
        M, positive.
    sample_time
        > 0, seconds; the input is held between samples.
    momentum
        ``"signed"``: g(u) = u, the elements of S3 table I (momentum of a memristor: charge; of a
        memcapacitor: the integral of charge; of a meminductor: of flux; of a memdamper: of force).
        ``"absolute"``: ``g(u) = |u|``, hysteresis in rates (S3 theorem 4).
    reset
        ``"never"``, or ``"sign-change"``: p is set to ``reset_to`` where u changes its sign, which
        is a reversal if u is a rate.
    start
        p before the first sample.
    reset_to
        What a reset sets p to.

    Raises
    ------
    InputError
        If an argument is not allowed.

    Notes
    -----
    S3 eqs. 4-6. For hysteresis between the integrals of u and y use ``RambergOsgood``, which is
    exact between samples too.

    Examples
    --------
    >>> memristor = MemoryElement(MemoryFunction.polynomial([1.0, 0.0, 0.5]), sample_time=0.5)
    >>> memristor([2.0, 2.0, 0.0, -2.0])
    array([ 2.,  3.,  0., -6.])
    >>> memristor.inverse()([2.0, 3.0, 0.0, -6.0])
    array([ 2.,  2.,  0., -2.])
    """

    kind = "memory-element"

    def exact_inverse(self) -> InverseMemoryElement:
        """Give the exact inverse ``u = y / M(p)`` (S3 theorem 8)."""
        return InverseMemoryElement(
            self.function, self.dt, self.momentum, self.reset, self.start, self.reset_to
        )

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False)
class InverseMemoryElement(_Element):
    """Inverse of a memory element: ``u = y / M(p)``, ``dp/dt = g(u)`` (S3 eqs. 19-20).

    Takes the arguments of ``MemoryElement``; it is usually made by ``MemoryElement.inverse()``.

    Parameters
    ----------
    function, sample_time, momentum, reset, start, reset_to
        As in ``MemoryElement``.

    Raises
    ------
    InputError
        If an argument is not allowed.

    Examples
    --------
    >>> damper = MemoryElement(MemoryFunction.polynomial([0.25]), sample_time=0.1)
    >>> damper.inverse()([1.0, -2.0])
    array([ 4., -8.])
    """

    kind = "inverse-memory-element"

    def exact_inverse(self) -> MemoryElement:
        """Give the memory element."""
        return MemoryElement(
            self.function, self.dt, self.momentum, self.reset, self.start, self.reset_to
        )

    def _is_inverse(self) -> bool:
        return True

"""A first-order lag of a signal, and its exact inverse."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive, as_sample_time, said
from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.portrait import NOTHING, Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]
Hold = Literal["first", "zero"]

SHORTEST, LONGEST = 1e-6, 1e15
"""Of a time constant, in samples: the lag is the identity, or never moves, to all digits."""


@dataclass(frozen=True, eq=False, init=False, repr=False)
class _FirstOrder(Operator):
    """What a lag and its inverse have in common: all constants."""

    time_constant: float
    sample_time: float
    hold: Hold

    def __init__(self, time_constant: float, dt: float, hold: Hold = "first") -> None:
        tau, sample = as_positive(time_constant, "time_constant", "seconds"), as_sample_time(dt)
        if not SHORTEST * sample <= tau <= LONGEST * sample:
            raise InputError(
                f"time_constant is {tau:.6g} s, {tau / sample:.3g} samples of {sample:.6g} s; give "
                f"one of {SHORTEST:g} to {LONGEST:g} samples"
            )
        if hold not in ("first", "zero"):
            raise InputError(
                f"hold is {said(hold)}; give 'first' for an input that is a line between samples, "
                "or 'zero' for one that is held until the output is read"
            )
        object.__setattr__(self, "time_constant", tau)
        object.__setattr__(self, "sample_time", sample)
        object.__setattr__(self, "hold", hold)

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def __repr__(self) -> str:
        held = "" if self.hold == "first" else f", hold={self.hold!r}"
        return f"{type(self).__name__}({self.time_constant!r}, dt={self.dt!r}{held})"

    def at_sample_time(self, dt: float) -> Self:
        """Give the same lag for records of another sample time: its constant is in seconds."""
        return type(self)(self.time_constant, dt, self.hold)

    def initial_state(self) -> Array:
        """Give no output, nothing carried over, no input, and that there was none, shape (4,)."""
        return np.zeros(4)

    def traits(self) -> Traits:
        """Give the traits of a linear memory that forgets."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=False,  # it falls on while the input begins to rise
            invertible=True,
        )

    def parameters(self) -> Parameters:
        """Give the time constant, s."""
        return Parameters(
            values=np.array([self.time_constant]),
            names=("time_constant",),
            lower=np.array([SHORTEST * self.dt]),
            upper=np.array([LONGEST * self.dt]),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the lag of another time constant; sample time and hold stay."""
        return type(self)(float(as_parameter_vector(theta, 1)[0]), self.dt, self.hold)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give one: time keeps its unit.

        Raises
        ------
        InputError
            If input and output grow by different factors.
        """
        if input_scale != output_scale:
            raise InputError(
                "a lag leaves the unit of its signal as it is; put the gain into an Affine or the "
                "model beside it"
            )
        return np.ones(1)

    def keeps_unit(self) -> bool:
        """Tell that what lags has the unit of the signal."""
        return True

    def portrait(self) -> Portrait:
        """Show nothing: a lag is seen over time, not over the input."""
        return NOTHING

    def to_dict(self) -> dict[str, Any]:
        """Give kind, time constant, sample time and hold."""
        return {
            "kind": self.kind,
            "time_constant": self.time_constant,
            "dt": self.dt,
            "hold": self.hold,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("time_constant", "dt"), ("hold",)))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is what has lagged."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {"inverse": int(self._is_inverse()), "held": int(self.hold == "zero")}
        return (Stage("lag", (self.time_constant,), choices=choices, dt=self.dt),)


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class Lag(_FirstOrder):
    """A first-order lag ``tau y' = u - y``, solved exactly between samples.

    ``y_k = a y_{k-1} + b_1 u_{k-1} + b_0 u_k`` with ``a = exp(-dt / tau)``. Where u is a line
    between samples, ``b_0 = 1 - (1 - a) tau / dt`` and ``b_1 = 1 - a - b_0``; where u is held and y
    read at the end of the hold, ``b_0 = 1 - a`` and ``b_1 = 0``. The signal has rested at its first
    sample, which passes as it is.

    Parameters
    ----------
    time_constant
        tau, s, > 0. Slow signals come tau late.
    dt
        Sample time, s.
    hold
        What u does between samples: ``"first"``, a line; ``"zero"``, held.

    Raises
    ------
    InputError
        If the time constant is not positive or not of 1e-6 to 1e15 samples, or hold is neither.

    Notes
    -----
    K. J. Astrom and B. Wittenmark, Computer-Controlled Systems, 3rd ed., Prentice Hall 1997, ch. 2
    (zero-order hold) and ch. 8 (first-order hold).

    Examples
    --------
    >>> lag = Lag(1.0, dt=1.0)
    >>> lag([0.0, 1.0, 1.0]).round(6)
    array([0.      , 0.367879, 0.767456])
    >>> lag.inverse()(lag([1.0, 3.0, 2.0])).round(12)
    array([1., 3., 2.])
    """

    kind = "lag"

    def lipschitz_constant(self) -> float:
        """Give 1: the output is a mean of what the input was."""
        return 1.0

    def exact_inverse(self) -> InverseLag:
        """Give the exact inverse; its only zero, ``-b_1 / b_0``, lies inside the unit circle.

        What is measured of y is made larger by up to ``InverseLag.lipschitz_constant()``: the
        inverse of a lag of many samples turns rounding and noise into large commands.
        """
        return InverseLag(self.time_constant, self.dt, self.hold)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class InverseLag(_FirstOrder):
    """Inverse of a first-order lag, from what has lagged to what was given.

    ``u_k = (y_k - a y_{k-1} - b_1 u_{k-1}) / b_0``; ``Lag.inverse()`` makes it.

    Parameters
    ----------
    time_constant, dt, hold
        As in ``Lag``.

    Raises
    ------
    InputError
        As ``Lag``.

    Examples
    --------
    >>> Lag(1.0, dt=1.0, hold="zero").inverse()([0.0, 1.0, 1.0]).round(6)
    array([0.      , 1.581977, 1.      ])
    """

    kind = "inverse-lag"

    def lipschitz_constant(self) -> float:
        """Give the sum of the absolute impulse response.

        It is ``(1 + a) / (b_0 - b_1)``: for a lag of n samples some 12 n^2 where u is a line
        between samples, 2 n where it is held.
        """
        x = self.dt / self.time_constant
        sum_of_both = 1.0 + math.exp(-x)
        return sum_of_both / _damping(x, self.hold) * (1.0 + 1e-9)

    def exact_inverse(self) -> Lag:
        """Give the lag."""
        return Lag(self.time_constant, self.dt, self.hold)

    def _is_inverse(self) -> bool:
        return True


def _damping(x: float, hold: Hold) -> float:
    """Give ``b_0 - b_1`` of a lag of 1/x samples with its digits."""
    gain = -math.expm1(-x)
    if hold == "zero":
        return gain
    if x >= 1.0:
        return 2.0 * (1.0 - gain / x) - gain
    # sum_k (-x)^k (k - 1) / (k + 1)!, from k = 2 on; it begins with x^2 / 6.
    term, total = x * x / 6.0, 0.0
    for k in range(2, 22):
        total += term * (k - 1)
        term *= -x / (k + 2)
    return total

"""Thresholds that move with the rate: a play as wide as a power of the rate of its input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_positive, as_sample_time
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Affine, Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))


@register
@final
@dataclass(frozen=True, eq=False, repr=False, init=False)
class RateShift(Operator):
    """Input as a switching material sees it whose thresholds move with the rate.

        z_k = clamp(z_{k-1}, u_k - b_k, u_k + b_k),   b_k = c |(u_k - u_{k-1}) / dt|^m

    In front of a model of relays, as ``Preisach(...) @ RateShift(c, m, dt)``, a relay of thresholds
    ``beta < alpha`` switches up where the rising input reaches ``alpha + b``, and down where the
    falling one reaches ``beta - b``: loops widen by 2 b. The first sample is taken to be at rest.

    Parameters
    ----------
    c
        Shift at a rate of 1, >= 0, input units over (input units per second) to the power m.
    m
        Exponent, > 0.
    dt
        Sample time, > 0, seconds.
    z0
        Output before the first sample, input units; at rest the first sample moves it to itself.

    Raises
    ------
    InputError
        If c is negative, m or dt is not positive, or a constant is not finite.

    Notes
    -----
    Coercive fields that grow as a power of the frequency: Ishibashi and Orihara, Integrated
    Ferroelectrics 9 (1995) 57-61; Scott, Integrated Ferroelectrics 12 (1996) 71-81.

    Examples
    --------
    >>> RateShift(c=0.5, m=0.5, dt=0.25)([0.0, 1.0, 2.0, 3.0, 2.75])
    array([0.  , 0.  , 1.  , 2.  , 2.25])
    """

    c: float
    m: float
    sample_time: float
    z0: float

    kind = "rate-shift"

    def __init__(self, c: float, m: float, dt: float, z0: float = 0.0) -> None:
        shift = as_number(c, "c")
        if shift < 0.0:
            raise InputError(
                f"c is {shift}; thresholds cannot come closer with the rate, so give zero or a "
                "positive number"
            )
        object.__setattr__(self, "c", shift)
        object.__setattr__(self, "m", as_positive(m, "m"))
        object.__setattr__(self, "sample_time", as_sample_time(dt))
        object.__setattr__(self, "z0", as_number(z0, "z0"))

    def __repr__(self) -> str:
        return f"RateShift(c={self.c!r}, m={self.m!r}, dt={self.dt!r}, z0={self.z0!r})"

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def at_sample_time(self, dt: float) -> RateShift:
        """Give the same shift for records of another sample time: rates are in seconds."""
        return self if dt == self.dt else RateShift(self.c, self.m, dt, self.z0)

    def shift_at(self, rate: float) -> float:
        """Give the shift of the thresholds at a rate.

        Parameters
        ----------
        rate
            Input units per second; its sign does not matter.

        Returns
        -------
        float
            Input units.
        """
        return float(self.c * abs(as_number(rate, "rate")) ** self.m)

    def traits(self) -> Traits:
        """Give the traits; without a shift it is the input itself."""
        plain = self.c == 0.0
        return Traits(
            memoryless=plain,
            rate_independent=Degree.EXACTLY if plain else Degree.NO,
            return_point_memory=plain,
            congruent_loops=plain,
            monotone=plain,
            invertible=plain,
        )

    def initial_state(self) -> Array:
        """Give output and input before the first sample, and that there is none, shape (3,)."""
        return np.array([self.z0, 0.0, 0.0])

    def exact_inverse(self) -> Operator:
        """Give the exact inverse where there is one: for c = 0.

        Raises
        ------
        NotInvertibleError
            If c is not 0: how wide the play is follows the rate of the drive, which is what an
            inverse has yet to find, and while the output rests no drive is told from another.
        """
        if self.c != 0.0:
            raise NotInvertibleError(
                f"c is {self.c:.6g}: the thresholds follow the rate of the drive, which an inverse "
                "does not know before it has found the drive; invert the model behind the shift, "
                "and simulate what the shift leaves"
            )
        return Affine(1.0, 0.0)

    def parameters(self) -> Parameters:
        """Give c and m."""
        return Parameters(
            values=np.array([self.c, self.m]),
            names=("c", "m"),
            lower=np.array([0.0, _SMALLEST]),
            upper=np.full(2, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> RateShift:
        """Give the shift of other constants."""
        c, m = as_parameter_vector(theta, 2).tolist()
        return RateShift(c, m, self.dt, self.z0)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of c and m.

        Raises
        ------
        InputError
            If the two scales differ: its output has the unit of its input.
        """
        if input_scale != output_scale:
            return super().parameter_scales(input_scale, output_scale)
        return np.array([input_scale ** (1.0 - self.m), 1.0])

    def in_units(self, input_scale: float, output_scale: float) -> RateShift:
        """Give the shift in other units, its output before the first sample too.

        Raises
        ------
        InputError
            As ``parameter_scales``.
        """
        scale = float(self.parameter_scales(input_scale, output_scale)[0])
        return RateShift(self.c * scale, self.m, self.dt, self.z0 * input_scale)

    def keeps_unit(self) -> bool:
        """Tell that the output has the unit of the input."""
        return True

    def lipschitz_constant(self) -> float:
        """Give 1 without a shift, ``1 + 2 c / dt`` for m = 1; no other power has one."""
        if self.c == 0.0:
            return 1.0
        return 1.0 + 2.0 * self.c / self.dt if self.m == 1.0 else float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and, where there is one, the output before the first sample."""
        memory = {"z0": self.z0} if self.z0 else {}
        return {"kind": self.kind, "c": self.c, "m": self.m, "dt": self.dt, **memory}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> RateShift:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("c", "m", "dt"), ("z0",)))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("rate_shift", (self.c, self.m), dt=self.dt),)

"""The Ramberg-Osgood model: hysteresis from three constants."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number, as_positive
from hyst.errors import InputError
from hyst.models.masing import (
    DEPTH,
    MasingOperator,
    Memory,
    as_memory,
    as_mode,
    memory_entries,
    reversal_traits,
)
from hyst.models.power_law import PowerLaw
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.portrait import Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Traits

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))


@register
@final
@dataclass(frozen=True, eq=False)
class RambergOsgood(Operator):
    """Ramberg-Osgood model: ``dy/du = c1 + c2 p^c3``, p the way since the last reversal.

    From a reversal (u_i, y_i) on ``y = y_i +- (c1 p + c2 p^(c3 + 1) / (c3 + 1))``. On the first
    loading, from 0, the coefficient is ``2^c3 c2`` in the place of c2.

    Parameters
    ----------
    c1
        Slope right after a reversal, >= 0, output units per input unit; 0 with c2 > 0 only. The
        output then starts without a slope from every turn, and the inverse with an infinite one.
    c2
        Growth of the slope, >= 0.
    c3
        Its power, > 0.
    memory
        ``"masing"``: reversals are nested and every loop closes, as those of real actuators do.
        ``"last-reversal"``: the published model, which forgets everything at each reversal and
        drifts after minor loops.
    depth
        Reversals there is room for with ``"masing"``; see ``MasingOperator``.
    dead_band
        With ``"last-reversal"``: by how much the input must go back before that counts as a
        reversal, input units.

    Raises
    ------
    InputError
        If c1 or c2 is negative or both are 0, c3 is not positive, or an argument is not allowed.
        Softening curves (-1 < c3 < 0) are taken by ``MasingOperator(PowerLaw(c1, c2, c3))``.

    Notes
    -----
    S3 eqs. 2-3 and theorem 4. No differential equation has to be solved: forwards a sample takes
    one power evaluation, backwards at most six (see ``InverseCurve``).

    Examples
    --------
    >>> model = RambergOsgood(1.0, 1.0, 1.0)
    >>> model([0.0, 3.0, 1.0, 2.0, 1.0, 0.0]).round(12)
    array([ 0. , 12. ,  8. ,  9.5,  8. ,  4.5])
    >>> model.inverse()([0.0, 12.0, 8.0, 9.5, 8.0, 4.5]).round(12)
    array([0., 3., 1., 2., 1., 0.])
    """

    c1: float
    c2: float
    c3: float
    memory: Memory = "masing"
    depth: int = DEPTH
    dead_band: float = 0.0

    kind = "ramberg-osgood"

    def __post_init__(self) -> None:
        for name in ("c1", "c2", "c3"):
            object.__setattr__(self, name, as_number(getattr(self, name), name))
        if self.c1 < 0.0 or (self.c1 == 0.0 and self.c2 <= 0.0):
            raise InputError(
                f"c1 is {self.c1:.6g} and c2 is {self.c2:.6g}; a Ramberg-Osgood model needs c1 "
                "positive, or 0 with a positive c2"
            )
        if self.c3 <= 0.0:
            raise InputError(
                f"c3 is {self.c3:.6g}; a Ramberg-Osgood model needs it positive "
                "(MasingOperator(PowerLaw(...)) takes -1 < c3 < 0)"
            )
        if self.c2 < 0.0:
            # By logarithms and bounded, for a small c3 puts it beyond the largest number.
            log_way = (math.log(self.c1) - math.log(-self.c2)) / self.c3
            raise InputError(
                f"c2 is {self.c2:.6g}; the slope c1 + c2 p^c3 would turn negative at "
                f"p = {math.exp(min(log_way, 700.0)):.6g}, so give 0 or more"
            )
        checked = as_memory(self.memory, self.depth, self.dead_band)
        object.__setattr__(self, "depth", int(self.depth))
        object.__setattr__(self, "dead_band", checked.dead_band)

    @classmethod
    def from_skeleton(
        cls,
        y_star: float,
        u_star: float,
        alpha: float,
        gamma: float,
        memory: Memory = "masing",
    ) -> RambergOsgood:
        """Give the model of a skeleton curve ``y/y* = u/u* (1 + alpha |u/u*|^(gamma - 1))``.

        ``c1 = y*/u*``, ``c2 = (y*/u*) alpha gamma / (2 u*)^(gamma - 1)``, ``c3 = gamma - 1``.

        Parameters
        ----------
        y_star, u_star
            > 0, output and input units.
        alpha
            >= 0.
        gamma
            > 1.
        memory
            As in the class.

        Returns
        -------
        RambergOsgood

        Raises
        ------
        InputError
            If a constant is out of its range.

        Notes
        -----
        S3 eq. 2 and theorem 4 (theorem 10 drops the factor ``y*/u*`` of c2).

        Examples
        --------
        >>> RambergOsgood.from_skeleton(y_star=2.0, u_star=1.0, alpha=0.5, gamma=3.0)([1.0])
        array([3.])
        """
        given = {"y_star": y_star, "u_star": u_star, "gamma - 1": as_number(gamma, "gamma") - 1.0}
        for name, value in given.items():
            as_positive(value, name)
        slope, power = y_star / u_star, gamma - 1.0
        growth = slope * as_number(alpha, "alpha") * gamma / (2.0 * u_star) ** power
        return cls(slope, growth, power, memory)

    def skeleton(self, u: ArrayLike) -> Array:
        """Give the initial loading curve (S3 eq. 2), odd.

        Parameters
        ----------
        u
            Input units.

        Returns
        -------
        numpy.ndarray
            In the shape of ``u``.
        """
        return self.curve(u)

    def slope(self, p: ArrayLike) -> Array:
        """Give ``M(p) = c1 + c2 p^c3``, the slope of a branch (S3 eq. 6).

        Parameters
        ----------
        p
            Way since the last reversal, >= 0, input units.

        Returns
        -------
        numpy.ndarray
            In the shape of ``p``.
        """
        return np.asarray(self.c1 + self.c2 * np.asarray(p, dtype=np.float64) ** self.c3)

    def with_memory(self, memory: str, dead_band: float = 0.0) -> RambergOsgood:
        """Give the model of the same constants with another memory.

        Parameters
        ----------
        memory
            ``"masing"`` or ``"last-reversal"``.
        dead_band
            With ``"last-reversal"``, input units.

        Returns
        -------
        RambergOsgood
        """
        return RambergOsgood(self.c1, self.c2, self.c3, as_mode(memory), self.depth, dead_band)

    @property
    def curve(self) -> PowerLaw:
        """The initial loading curve."""
        return PowerLaw(self.c1, self.c2, self.c3)

    def traits(self) -> Traits:
        """Give the traits; with the last reversal alone, loops do not close after minor loops."""
        memory = as_memory(self.memory, self.depth, self.dead_band)
        return reversal_traits(memory, invertible=True)

    def initial_state(self) -> Array:
        """Give the state without memory: last input and output, counts, and room for reversals."""
        return self._as_masing().initial_state()

    def overflowed(self, state: ArrayLike) -> bool:
        """Tell whether a reversal has found no room and its loop was traced without area.

        Parameters
        ----------
        state
            As ``run`` gave it.

        Returns
        -------
        bool
        """
        return self._as_masing().overflowed(state)

    def exact_inverse(self) -> MasingOperator:
        """Give the exact inverse in the same memory: the operator of the inverse loading curve.

        Notes
        -----
        S3 theorem 10, without the differential equation.
        """
        return self._as_masing().exact_inverse()

    def parameters(self) -> Parameters:
        """Give c1, c2, c3."""
        return Parameters(
            values=np.array([self.c1, self.c2, self.c3]),
            names=("c1", "c2", "c3"),
            lower=np.array([min(self.c1, _SMALLEST), 0.0, _SMALLEST]),
            upper=np.full(3, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> RambergOsgood:
        """Give the model of other constants with the same memory."""
        c1, c2, c3 = as_parameter_vector(theta, 3).tolist()
        return RambergOsgood(c1, c2, c3, self.memory, self.depth, self.dead_band)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of c1, c2 and c3; that of c2 depends on c3."""
        ratio = output_scale / input_scale
        return np.array([ratio, ratio * input_scale**-self.c3, 1.0])

    def in_units(self, input_scale: float, output_scale: float) -> RambergOsgood:
        """Give the model in other units, its dead band too."""
        c1, c2, c3 = self.parameter_scales(input_scale, output_scale) * [self.c1, self.c2, self.c3]
        dead_band = self.dead_band * input_scale
        return RambergOsgood(c1, c2, c3, self.memory, self.depth, dead_band)

    def portrait(self) -> Portrait:
        """Show the loading curve."""
        return Portrait(("curve",), self.curve)

    def lipschitz_constant(self) -> float:
        """Give infinity, for the slope grows without bound; c1 where c2 is 0."""
        return self._as_masing().lipschitz_constant()

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and memory."""
        constants = {"c1": self.c1, "c2": self.c2, "c3": self.c3}
        return {"kind": self.kind, **constants, **memory_entries(self)}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> RambergOsgood:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("c1", "c2", "c3", "memory"), ("depth", "dead_band")))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return self._as_masing().stages()

    def _as_masing(self) -> MasingOperator:
        return MasingOperator(self.curve, self.memory, self.depth, self.dead_band)

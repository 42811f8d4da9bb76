"""Jiles and Atherton's magnet with eddy currents, and its inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_sample_time
from hyst.errors import InputError
from hyst.models.jiles_atherton import MAGNETISATION, JilesAtherton
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, init=False, repr=False)
class _Lossy(Operator):
    """What the magnet with losses and its inverse have in common: all constants."""

    magnet: JilesAtherton
    k_cl: float
    k_ex: float
    sample_time: float

    def __init__(self, magnet: JilesAtherton, k_cl: float, k_ex: float, dt: float) -> None:
        if not isinstance(magnet, JilesAtherton):
            raise InputError(
                f"the magnet is of type {type(magnet).__name__}; give a hyst.JilesAtherton"
            )
        object.__setattr__(self, "magnet", magnet)
        object.__setattr__(self, "k_cl", as_not_negative(k_cl, "k_cl"))
        object.__setattr__(self, "k_ex", as_not_negative(k_ex, "k_ex"))
        object.__setattr__(self, "sample_time", as_sample_time(dt))

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def __repr__(self) -> str:
        constants = f"{self.magnet!r}, k_cl={self.k_cl!r}, k_ex={self.k_ex!r}, dt={self.dt!r}"
        return f"{type(self).__name__}({constants})"

    def at_sample_time(self, dt: float) -> Self:
        """Give the same magnet for records of another sample time: rates are in seconds."""
        return self if dt == self.dt else type(self)(self.magnet, self.k_cl, self.k_ex, dt)

    def initial_state(self) -> Array:
        """Give the demagnetised state, shape (8,): zeros."""
        return self.magnet.initial_state()

    def parameters(self) -> Parameters:
        """Give Ms, a, k, c and alpha of the magnet, k_cl and k_ex."""
        still = self.magnet.parameters()
        return Parameters(
            values=np.array([*still.values, self.k_cl, self.k_ex]),
            names=(*still.names, "k_cl", "k_ex"),
            lower=np.array([*still.lower, 0.0, 0.0]),
            upper=np.array([*still.upper, np.inf, np.inf]),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the magnet of other constants, of the same variant, output and sample time."""
        *still, k_cl, k_ex = as_parameter_vector(theta, 7).tolist()
        return type(self)(self.magnet.with_parameters(still), k_cl, k_ex, self.dt)

    def lipschitz_constant(self) -> float:
        """Give infinity, as the magnet does."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, the magnet, its losses and the sample time."""
        losses = {"k_cl": self.k_cl, "k_ex": self.k_ex, "dt": self.dt}
        return {"kind": self.kind, "magnet": self.magnet.to_dict(), **losses}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        said = entries(data, ("magnet", "k_cl", "k_ex", "dt"))
        return cls(**{**said, "magnet": JilesAtherton.from_dict(said["magnet"])})

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is M or B."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        (still,) = self.magnet.stages()
        constants = (*still.constants, self.k_cl, self.k_ex)
        choices = {**still.choices, "inverse": int(self._is_inverse())}
        return (replace(still, constants=constants, choices=choices, dt=self.dt),)


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class DynamicJilesAtherton(_Lossy):
    """A magnet whose eddy currents hold the field up: ``y = magnet[H_within]``.

        H_within = H - k_cl dy/dt - k_ex sgn(dy/dt) |dy/dt|^(1/2)

    y is the magnet's output, M or B, and its rate that of the line from sample to sample,
    ``dy/dt = (y_k - y_{k-1}) / dt``, with which a sample is solved to rounding. It is the backward
    Euler method of the equation in continuous time: halved sample times halve what it is off.

    Parameters
    ----------
    magnet
        The magnet at rest: a ``JilesAtherton``.
    k_cl
        >= 0, classical losses, input units per output unit and second: ``sigma d^2 / 12`` of a
        sheet of thickness d and conductivity sigma, where the output is B.
    k_ex
        >= 0, excess losses, input units per root of output units per second:
        ``(sigma G V0 S)^(1/2)``, where the output is B.
    dt
        > 0, sample time, seconds.

    Raises
    ------
    InputError
        If a constant is negative or not finite, or the magnet is none.

    Notes
    -----
    G. Bertotti, General properties of power losses in soft ferromagnetic materials, IEEE Trans.
    Magn. 24 (1988) 621-630; D. C. Jiles, Modelling the effects of eddy current losses on frequency
    dependent hysteresis in electrically conducting media, IEEE Trans. Magn. 30 (1994) 4326-4328.
    Fields are taken to be even over the sheet, which holds where it is thinner than the skin depth.

    Examples
    --------
    >>> magnet = JilesAtherton(Ms=1.0, a=1.0, k=0.5, c=0.2, alpha=1.0)
    >>> coil = DynamicJilesAtherton(magnet, k_cl=0.1, k_ex=0.2, dt=0.1)
    >>> coil([2.0, 2.0, 0.5]).round(4)
    array([0.3658, 0.4814, 0.4107])
    >>> coil.inverse()(coil([2.0, 2.0, 0.5])).round(6)
    array([2. , 2. , 0.5])
    """

    kind = "dynamic-jiles-atherton"

    def traits(self) -> Traits:
        """Give the traits of the magnet, of which losses leave what an inverse needs."""
        still = self.k_cl == 0.0 and self.k_ex == 0.0
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY if still else Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=still,
            invertible=self.magnet.is_invertible,
        )

    def exact_inverse(self) -> InverseDynamicJilesAtherton:
        """Give the inverse, from M or B to H: that of the magnet, and the losses of the rate.

        With excess losses H comes back to the root of a rounding only where y hardly moves.

        Raises
        ------
        NotInvertibleError
            If the output is M and c is 0: right after a turn M rests.
        """
        self.magnet.inverse()
        return InverseDynamicJilesAtherton(self.magnet, self.k_cl, self.k_ex, self.dt)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of Ms, a, k, c, alpha, k_cl and k_ex."""
        still = self.magnet.parameter_scales(input_scale, output_scale)
        losses = [input_scale / output_scale, input_scale / float(np.sqrt(output_scale))]
        return np.array([*still, *losses])

    def in_units(self, input_scale: float, output_scale: float) -> DynamicJilesAtherton:
        """Give the magnet in other units."""
        *_, k_cl, k_ex = (
            self.parameters().values * self.parameter_scales(input_scale, output_scale)
        ).tolist()
        magnet = self.magnet.in_units(input_scale, output_scale)
        return DynamicJilesAtherton(magnet, k_cl, k_ex, self.dt)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class InverseDynamicJilesAtherton(_Lossy):
    """Inverse of a magnet with eddy currents, from M or B to H; its ``inverse()`` makes it.

    Parameters
    ----------
    magnet, k_cl, k_ex, dt
        As in ``DynamicJilesAtherton``.

    Raises
    ------
    InputError
        As ``DynamicJilesAtherton``, and if c is 0 and the output M.

    Examples
    --------
    >>> magnet = JilesAtherton(1.0, 1.0, 0.5, 0.2, 1.0)
    >>> back = DynamicJilesAtherton(magnet, 0.5, 0.0, 0.1).inverse()
    >>> (back([0.1, 0.1]) - magnet.inverse()([0.1, 0.1])).round(12)
    array([0.5, 0. ])
    """

    kind = "inverse-dynamic-jiles-atherton"

    def __init__(self, magnet: JilesAtherton, k_cl: float, k_ex: float, dt: float) -> None:
        super().__init__(magnet, k_cl, k_ex, dt)
        if magnet.c == 0.0 and magnet.output == MAGNETISATION:
            raise InputError("c is 0, where M rests after a turn and has no inverse; give c > 0")

    def traits(self) -> Traits:
        """Give the traits of a field that the output determines."""
        still = self.k_cl == 0.0 and self.k_ex == 0.0
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY if still else Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=still,
            invertible=True,
        )

    def exact_inverse(self) -> DynamicJilesAtherton:
        """Give the magnet."""
        return DynamicJilesAtherton(self.magnet, self.k_cl, self.k_ex, self.dt)

    def _is_inverse(self) -> bool:
        return True

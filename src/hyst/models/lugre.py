"""LuGre friction: bristles that bend before sliding, a Stribeck curve, and viscosity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_positive, as_sample_time
from hyst.errors import NotInvertibleError
from hyst.models.sliding_elements import as_stribeck
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_NAMES = ("sigma0", "sigma1", "sigma2", "Fc", "Fs", "vs", "Fv", "vv")
_SMALLEST = float(np.nextafter(0.0, 1.0))


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class LuGre(Operator):
    """LuGre friction: bristles z that bend, and slide at the force of a Stribeck curve s.

        dz/dt = v - sigma0 |v| z / s(v)
        y = sigma0 z + sigma1 dz/dt + sigma2 v + Fv tanh(v / vv)
        s(v) = Fc + (Fs - Fc) exp(-(v / vs)^2)

    The velocity is taken as constant from sample to sample, ``v = (u_k - u_{k-1}) / dt``, and a
    sample is then exact. The output is the force at the end of the sample, at u_k, while its
    velocity still lasts. The velocity of the very first sample is 0, and so is the force before it.

    Parameters
    ----------
    sigma0
        > 0, stiffness of the bristles, output units per input unit.
    sigma1
        >= 0, damping of the bristles, output units per input unit and second.
    sigma2
        >= 0, viscosity, output units per input unit and second.
    Fc
        > 0, force of fast sliding without viscosity, output units.
    Fs
        >= Fc, force of slow sliding, output units.
    vs
        > 0, Stribeck velocity, input units per second; without effect where Fs is Fc.
    dt
        > 0, sample time, seconds.
    Fv
        >= 0, what viscosity that saturates ends at, output units, as that of fluids which thin as
        they are sheared; none by default.
    vv
        > 0, its velocity, input units per second; without effect where Fv is 0.

    Raises
    ------
    InputError
        If a constant is negative, zero where it must not be or not finite, or Fs is below Fc.

    Notes
    -----
    C. Canudas de Wit, H. Olsson, K. J. Astrom and P. Lischinsky, A new model for control of systems
    with friction, IEEE Trans. Automatic Control 40 (1995) 419-425, eqs. 3-5, with a
    viscous force of two terms.

    Examples
    --------
    >>> friction = LuGre(sigma0=2.0, sigma1=0.0, sigma2=0.0, Fc=1.0, Fs=1.0, vs=1.0, dt=0.1)
    >>> friction([0.0, 0.5, 0.0]).round(6)
    array([ 0.      ,  0.632121, -0.399576])
    """

    sigma0: float
    sigma1: float
    sigma2: float
    Fc: float
    Fs: float
    vs: float
    sample_time: float
    Fv: float
    vv: float

    kind = "lugre"

    def __init__(
        self,
        sigma0: float,
        sigma1: float,
        sigma2: float,
        Fc: float,
        Fs: float,
        vs: float,
        dt: float,
        Fv: float = 0.0,
        vv: float = 1.0,
    ) -> None:
        object.__setattr__(self, "sigma0", as_positive(sigma0, "sigma0"))
        object.__setattr__(self, "sigma1", as_not_negative(sigma1, "sigma1"))
        object.__setattr__(self, "sigma2", as_not_negative(sigma2, "sigma2"))
        for name, value in zip(("Fc", "Fs", "vs"), as_stribeck(Fc, Fs, vs), strict=True):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "sample_time", as_sample_time(dt))
        object.__setattr__(self, "Fv", as_not_negative(Fv, "Fv"))
        object.__setattr__(self, "vv", as_positive(vv, "vv"))

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def __repr__(self) -> str:
        constants = ", ".join(f"{name}={getattr(self, name)!r}" for name in _NAMES)
        return f"LuGre({constants}, dt={self.dt!r})"

    def at_sample_time(self, dt: float) -> LuGre:
        """Give the same model for records of another sample time: rates are in seconds."""
        return self if dt == self.dt else self._of(self._constants(), dt)

    def passivity_margin(self) -> float:
        """Give ``sigma2 - sigma1 (Fs / Fc - 1)``; below 0 friction would give energy away.

        Not negative is necessary and sufficient for a passive map from velocity to force. It is
        sufficient since with the energy ``w^2 / (2 sigma0)`` of the bristles, w = sigma0 z, the
        power lost is ``sigma2 v^2 + sigma1 v (v - |v| w / s) + |v| w^2 / s`` at least, and no |w|
        passes Fs.

        Returns
        -------
        float
            Output units per input unit and second.

        Notes
        -----
        N. Barabanov and R. Ortega, Necessary and sufficient conditions for passivity of the LuGre
        friction model, IEEE Trans. Automatic Control 45 (2000) 830-832.

        Examples
        --------
        >>> LuGre(1e5, 300.0, 100.0, Fc=1.0, Fs=1.5, vs=1e-3, dt=1e-3).passivity_margin()
        -50.0
        """
        return self.sigma2 - self.sigma1 * (self.Fs / self.Fc - 1.0)

    def traits(self) -> Traits:
        """Give the traits; without Stribeck curve and damping it is Dahl's model."""
        plain = not (self.sigma1 or self.sigma2 or self.Fv) and self.Fs == self.Fc
        return Traits(
            memoryless=False,
            rate_independent=Degree.TO_ROUNDING if plain else Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=plain,
            invertible=False,
        )

    def initial_state(self) -> Array:
        """Give position, force of the bristles, its rest, and that there is no last sample."""
        return np.zeros(4)

    def exact_inverse(self) -> Operator:
        """Refuse: a force says how fast friction slides, if that, and not where it is.

        Raises
        ------
        NotInvertibleError
            Always; the reason is that of the constants.
        """
        if self.Fs > self.Fc:
            raise NotInvertibleError(
                f"Fs is {self.Fs:.6g} and Fc {self.Fc:.6g}: on the falling Stribeck curve two "
                "velocities have one force, so a force does not tell the position; Dahl's model "
                "has an exact inverse"
            )
        if not (self.sigma2 or self.Fv):
            raise NotInvertibleError(
                f"sigma2 and Fv are 0: in sliding the force is {self.Fc:.6g} whatever the "
                "velocity, so it does not tell the position; hyst.Dahl, to which these constants "
                "come down in slow motion, inverts forces below that of sliding"
            )
        raise NotInvertibleError(
            f"sigma2 is {self.sigma2:.6g} and Fv {self.Fv:.6g}: in sliding a force tells a "
            "velocity only, which adds up to a position with every error of the force; command the "
            "velocity instead"
        )

    def parameters(self) -> Parameters:
        """Give sigma0, sigma1, sigma2, Fc, Fs, vs, Fv and vv."""
        return Parameters(
            values=np.array(self._constants()),
            names=_NAMES,
            lower=np.array([_SMALLEST, 0.0, 0.0, *(3 * [_SMALLEST]), 0.0, _SMALLEST]),
            upper=np.full(len(_NAMES), np.inf),
        )

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the vector with Fs no less than Fc."""
        nearest = theta.copy()
        nearest[4] = max(theta[3], theta[4])
        return nearest

    def with_parameters(self, theta: Sequence[float] | Array) -> LuGre:
        """Give the model of other constants with the same sample time."""
        return self._of(as_parameter_vector(theta, len(_NAMES)).tolist(), self.dt)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants."""
        ratio = output_scale / input_scale
        curve = [output_scale, output_scale, input_scale]
        return np.array([ratio, ratio, ratio, *curve, output_scale, input_scale])

    def in_units(self, input_scale: float, output_scale: float) -> LuGre:
        """Give the model in other units."""
        scales = self.parameter_scales(input_scale, output_scale)
        return self.with_parameters(scales * self.parameters().values)

    def lipschitz_constant(self) -> float:
        """Give infinity: many small ways wear the force down as one large way does."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and sample time."""
        return {
            "kind": self.kind,
            **dict(zip(_NAMES, self._constants(), strict=True)),
            "dt": self.dt,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> LuGre:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, (*_NAMES, "dt")))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("lugre", self._constants(), dt=self.dt),)

    def _constants(self) -> tuple[float, ...]:
        return tuple(getattr(self, name) for name in _NAMES)

    @staticmethod
    def _of(constants: Sequence[float], dt: float) -> LuGre:
        return LuGre(**dict(zip(_NAMES, constants, strict=True)), dt=dt)

"""Generalized Maxwell-slip friction: sliding elements whose force follows the Stribeck curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_not_negative, as_positive, as_sample_time
from hyst.errors import InputError, NotInvertibleError
from hyst.models.sliding_elements import as_positive_entries, as_stribeck, require_one_each
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_SINGLE = ("C", "Fc", "Fs", "vs", "delta", "sigma2")
_SMALLEST = float(np.nextafter(0.0, 1.0))


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class GeneralizedMaxwellSlip(Operator):
    """Generalized Maxwell-slip friction: ``y = sum_i F_i + sigma2 v``.

        sticking   dF_i/dt = k_i v                            until F_i = alpha_i s(v) sgn v
        sliding    dF_i/dt = C (alpha_i sgn v - F_i / s(v))   until v turns or rests
        s(v) = Fc + (Fs - Fc) exp(-|v / vs|^delta)

    The velocity is taken as constant from sample to sample, ``v = (u_k - u_{k-1}) / dt``, and a
    sample is then exact, the instant at which an element begins to slide included. The output is
    the force at the end of the sample, at u_k, while its velocity still lasts. The velocity of the
    very first sample is 0, and no element bears anything before it.

    Parameters
    ----------
    k
        Shape (n,), n >= 1, > 0, stiffnesses of the elements, output units per input unit.
    alpha
        Shape (n,), > 0, share of s(v) that each element bears; they add up to 1 where s(v) is to be
        the force of the whole. Only the products with Fc and Fs count: hold one of them in a fit.
    C
        >= 0, how fast the force follows the curve in sliding, output units per second.
    Fc
        > 0, force of fast sliding without viscosity, output units.
    Fs
        >= Fc, force of slow sliding, output units.
    vs
        > 0, Stribeck velocity, input units per second; without effect where Fs is Fc.
    dt
        > 0, sample time, seconds.
    delta
        > 0, shape of the Stribeck curve.
    sigma2
        >= 0, viscosity, output units per input unit and second.

    Raises
    ------
    InputError
        If lengths differ, there is no element, a constant is negative, zero where it must not be or
        not finite, or Fs is below Fc.

    Notes
    -----
    V. Lampaert, J. Swevers and F. Al-Bender, IEEE Trans. Automatic Control 47 (2002) 683-687; F.
    Al-Bender, V. Lampaert and J. Swevers, The generalized Maxwell-slip model, IEEE Trans. Automatic
    Control 50 (2005) 1883-1887, eqs. 6-8, where s has the sign of v.

    Examples
    --------
    >>> friction = GeneralizedMaxwellSlip([2.0, 1.0], [0.5, 0.5], 1.0, 2.0, 2.0, 1.0, dt=0.1)
    >>> friction([0.0, 0.25, 2.0, 1.5])
    array([0.  , 0.75, 2.  , 0.5 ])
    """

    k: Array
    alpha: Array
    C: float
    Fc: float
    Fs: float
    vs: float
    sample_time: float
    delta: float
    sigma2: float

    kind = "generalized-maxwell-slip"

    def __init__(
        self,
        k: ArrayLike,
        alpha: ArrayLike,
        C: float,
        Fc: float,
        Fs: float,
        vs: float,
        dt: float,
        delta: float = 2.0,
        sigma2: float = 0.0,
    ) -> None:
        stiffness, share = as_positive_entries(k, "k"), as_positive_entries(alpha, "alpha")
        require_one_each(share, stiffness, "alpha", "k")
        if not stiffness.size:
            raise InputError("k has no entry; give one element or more")
        object.__setattr__(self, "k", stiffness)
        object.__setattr__(self, "alpha", share)
        object.__setattr__(self, "C", as_not_negative(C, "C"))
        for name, value in zip(("Fc", "Fs", "vs"), as_stribeck(Fc, Fs, vs), strict=True):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "sample_time", as_sample_time(dt))
        object.__setattr__(self, "delta", as_positive(delta, "delta"))
        object.__setattr__(self, "sigma2", as_not_negative(sigma2, "sigma2"))

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def __repr__(self) -> str:
        constants = ", ".join(f"{name}={getattr(self, name)!r}" for name in _SINGLE)
        return f"GeneralizedMaxwellSlip({self.k!r}, {self.alpha!r}, {constants}, dt={self.dt!r})"

    def at_sample_time(self, dt: float) -> GeneralizedMaxwellSlip:
        """Give the same model for records of another sample time: rates are in seconds."""
        return self if dt == self.dt else self._of(self.parameters().values, dt)

    def traits(self) -> Traits:
        """Give none: its force depends on the velocity."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=False,
            invertible=False,
        )

    def initial_state(self) -> Array:
        """Give force, its rest and way of sliding of each element, and that none was before."""
        return np.zeros(3 * self.k.size + 2)

    def exact_inverse(self) -> Operator:
        """Refuse: in sliding a force does not tell a position.

        Raises
        ------
        NotInvertibleError
            Always.
        """
        raise NotInvertibleError(
            f"Fc is {self.Fc:.6g}: once all elements slide the force follows the velocity alone, "
            "so it does not tell the position; where velocities do not matter, "
            "hyst.MaxwellSlip with a spring k0 > 0 has an exact inverse"
        )

    def parameters(self) -> Parameters:
        """Give k, alpha, then C, Fc, Fs, vs, delta and sigma2."""
        n = self.k.size
        least = dict.fromkeys(_SINGLE, _SMALLEST) | {"C": 0.0, "sigma2": 0.0}
        return Parameters(
            values=np.concatenate([self.k, self.alpha, [getattr(self, name) for name in _SINGLE]]),
            names=(*numbered("k", n), *numbered("alpha", n), *_SINGLE),
            lower=np.concatenate([np.full(2 * n, _SMALLEST), list(least.values())]),
            upper=np.full(2 * n + len(_SINGLE), np.inf),
        )

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the vector with Fs no less than Fc."""
        nearest, at = theta.copy(), 2 * self.k.size
        nearest[at + 2] = max(theta[at + 1], theta[at + 2])
        return nearest

    def with_parameters(self, theta: Sequence[float] | Array) -> GeneralizedMaxwellSlip:
        """Give the model of other constants with the same sample time."""
        return self._of(as_parameter_vector(theta, 2 * self.k.size + len(_SINGLE)), self.dt)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of k, alpha, C, Fc, Fs, vs, delta and sigma2."""
        n, ratio = self.k.size, output_scale / input_scale
        of_single = [output_scale, output_scale, output_scale, input_scale, 1.0, ratio]
        return np.concatenate([np.full(n, ratio), np.ones(n), of_single])

    def in_units(self, input_scale: float, output_scale: float) -> GeneralizedMaxwellSlip:
        """Give the model in other units."""
        scales = self.parameter_scales(input_scale, output_scale)
        return self.with_parameters(scales * self.parameters().values)

    def lipschitz_constant(self) -> float:
        """Give infinity: where an element begins to slide above the curve its force drops."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and sample time."""
        return {
            "kind": self.kind,
            "k": self.k.tolist(),
            "alpha": self.alpha.tolist(),
            **{name: getattr(self, name) for name in _SINGLE},
            "dt": self.dt,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> GeneralizedMaxwellSlip:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("k", "alpha", *_SINGLE, "dt")))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        constants = tuple(self.parameters().values.tolist())
        return (Stage("generalized_maxwell_slip", constants, dt=self.dt),)

    def _of(self, vector: Array, dt: float) -> GeneralizedMaxwellSlip:
        n = self.k.size
        single = dict(zip(_SINGLE, vector[2 * n :].tolist(), strict=True))
        return GeneralizedMaxwellSlip(vector[:n], vector[n : 2 * n], dt=dt, **single)

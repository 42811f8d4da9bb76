"""The loading curve of Jenkins elements in parallel: Iwan's, with Segalman's four parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number, as_positive
from hyst.errors import InputError
from hyst.models.loading_curve import (
    InverseCurve,
    LoadingCurve,
    ReversalMemory,
    refuse_flat,
    register_curve,
)
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))


@final
@dataclass(frozen=True)
class IwanCurve(LoadingCurve):
    """Iwan's model: ``f(x) = (K_T + K_inf) x - q x^(chi + 2)``, ``F_S + K_inf x`` beyond phi_max.

    Springs with a slider each, in parallel: the ways to slip phi are spread by
    ``rho(phi) = R phi^chi`` up to phi_max, where all that is left slips at once, and one spring has
    no slider.

    Parameters
    ----------
    F_S
        > 0, force at which all sliders slip (macro-slip), without the spring K_inf, output units.
    K_T
        > 0, stiffness of all elements with a slider at rest, output units per input unit.
    chi
        > -1, exponent of the spread; 0 is Iwan's uniform one, whose curve is a parabola.
    beta
        >= 0, stiffness of the elements that slip at phi_max over that of all others: how sudden
        macro-slip is.
    K_inf
        >= 0, stiffness that is left in macro-slip, output units per input unit.

    Raises
    ------
    InputError
        If a constant is not finite or out of its range.

    Notes
    -----
    D. J. Segalman, A four-parameter Iwan model for lap-type joints, J. Appl. Mech. 72 (2005)
    752-760, in whose letters ``phi_max = F_S (1 + beta) / (K_T (beta + (chi + 1) / (chi + 2)))``.
    W. D. Iwan, A distributed-element model for hysteresis and its steady-state dynamic response,
    J. Appl. Mech. 33 (1966) 893-900. The spring K_inf is added.

    Examples
    --------
    >>> curve = IwanCurve(F_S=1.0, K_T=2.0, chi=0.0, beta=0.0)  # uniform: 2 x - x^2, up to 1
    >>> curve([0.0, 0.5, 1.0, 3.0])
    array([0.  , 0.75, 1.  , 1.  ])
    >>> curve.phi_max
    1.0
    """

    F_S: float
    K_T: float
    chi: float = 0.0
    beta: float = 0.0
    K_inf: float = 0.0

    kind = "iwan"

    def __post_init__(self) -> None:
        for name in ("F_S", "K_T"):
            object.__setattr__(self, name, as_positive(getattr(self, name), name))
        for name in ("chi", "beta", "K_inf"):
            object.__setattr__(self, name, as_number(getattr(self, name), name))
        if self.chi <= -1.0:
            raise InputError(
                f"chi is {self.chi:.6g}; the stiffness of all elements is finite for chi above -1 "
                "only"
            )
        for name in ("beta", "K_inf"):
            if getattr(self, name) < 0.0:
                raise InputError(
                    f"{name} is {getattr(self, name):.6g}; elements have a stiffness of 0 or more"
                )

    @property
    def phi_max(self) -> float:
        """The way at which the last slider slips, input units."""
        share = self.beta + (self.chi + 1.0) / (self.chi + 2.0)
        return self.F_S * (1.0 + self.beta) / (self.K_T * share)

    def __call__(self, x: ArrayLike) -> Array:
        """Give f(x), odd, in the shape of x."""
        values = np.asarray(x, dtype=np.float64)
        along, limit = np.abs(values), self.phi_max
        share = np.minimum(along / limit, 1.0) ** (self.chi + 1.0) / (self.chi + 2.0)
        f = along * (self.K_T * (1.0 - share / (1.0 + self.beta)) + self.K_inf)
        f = np.where(along < limit, f, self.F_S + self.K_inf * along)
        return np.asarray(np.copysign(f, values))

    def inverse(self) -> LoadingCurve:
        """Give the inverse function, solved point by point.

        Raises
        ------
        NotInvertibleError
            If K_inf is 0: the force stays at F_S in macro-slip.
        """
        refuse_flat(self.phi_max if self.K_inf == 0.0 else None)
        return InverseCurve(self)

    def extreme_slopes(self) -> Array:
        """Give f' at 0, before macro-slip and in it."""
        last = self.K_T * self.beta / (1.0 + self.beta)
        return np.array([self.K_T, last, 0.0]) + self.K_inf

    @property
    def is_straight(self) -> bool:
        """Always False: something slips."""
        return False

    def parameters(self) -> Parameters:
        """Give F_S, K_T, chi, beta, K_inf."""
        return Parameters(
            values=np.array([self.F_S, self.K_T, self.chi, self.beta, self.K_inf]),
            names=("F_S", "K_T", "chi", "beta", "K_inf"),
            lower=np.array([_SMALLEST, _SMALLEST, float(np.nextafter(-1.0, 0.0)), 0.0, 0.0]),
            upper=np.full(5, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> IwanCurve:
        """Give another spread."""
        return IwanCurve(*as_parameter_vector(theta, 5).tolist())

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants."""
        ratio = output_scale / input_scale
        return np.array([output_scale, ratio, 1.0, 1.0, ratio])

    def to_dict(self) -> dict[str, Any]:
        """Give kind and constants."""
        names = ("F_S", "K_T", "chi", "beta", "K_inf")
        return {"kind": self.kind, **{name: getattr(self, name) for name in names}}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> IwanCurve:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("F_S", "K_T", "chi", "beta", "K_inf")))

    def stage(self, memory: ReversalMemory, inverse: bool) -> Stage:
        """Give the stage of this curve with a ``memory`` of reversals, or of its ``inverse``."""
        return memory.stage("iwan", tuple(self.parameters().values.tolist()), inverse)


register_curve(IwanCurve)

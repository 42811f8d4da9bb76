"""Iwan's model of joints: elastic-plastic elements in parallel, in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.models.iwan_curve import IwanCurve
from hyst.models.masing import DEPTH, MasingOperator, as_memory, reversal_traits
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.portrait import Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Traits

Array = NDArray[np.float64]

_NAMES = ("F_S", "K_T", "chi", "beta", "K_inf")


@register
@final
@dataclass(frozen=True, eq=False)
class Iwan(Operator):
    """Iwan's model: infinitely many springs with a slider each, in parallel, in closed form.

    First ``y = f(u)``, f the ``IwanCurve``; from a reversal (u_i, y_i) on
    ``y = y_i + 2 sign(u - u_i) f(|u - u_i| / 2)``.

    Parameters
    ----------
    F_S
        > 0, force of macro-slip without the spring K_inf, output units.
    K_T
        > 0, stiffness of the elements with a slider at rest, output units per input unit.
    chi
        > -1, exponent of the spread of the ways to slip; 0 is Iwan's uniform one.
    beta
        >= 0, how sudden macro-slip is: stiffness of the elements that slip last over that of all
        others.
    K_inf
        >= 0, stiffness that is left in macro-slip, output units per input unit.
    depth
        Reversals there is room for; see ``MasingOperator``.

    Raises
    ------
    InputError
        If a constant is not finite or out of its range.

    Notes
    -----
    D. J. Segalman, J. Appl. Mech. 72 (2005) 752-760; W. D. Iwan, J. Appl. Mech. 33 (1966) 893-900.
    The loss of a small loop of amplitude a goes with ``a^(chi + 3)``.

    Examples
    --------
    >>> joint = Iwan(F_S=1.0, K_T=2.0, K_inf=0.5)  # 2 x - x^2 + x / 2
    >>> joint([0.0, 1.0, 0.0, -1.0])
    array([ 0. ,  1.5, -0.5, -1.5])
    >>> joint.inverse()([0.0, 1.5, -0.5, -1.5]).round(12)
    array([ 0.,  1.,  0., -1.])
    """

    F_S: float
    K_T: float
    chi: float = 0.0
    beta: float = 0.0
    K_inf: float = 0.0
    depth: int = DEPTH

    kind = "iwan"

    def __post_init__(self) -> None:
        for name in _NAMES:
            object.__setattr__(self, name, getattr(self.curve, name))
        object.__setattr__(self, "depth", as_memory("masing", self.depth, 0.0).depth)

    @property
    def curve(self) -> IwanCurve:
        """The initial loading curve."""
        return IwanCurve(self.F_S, self.K_T, self.chi, self.beta, self.K_inf)

    @property
    def phi_max(self) -> float:
        """The way at which the last slider slips, input units; twice that from a reversal on."""
        return self.curve.phi_max

    def traits(self) -> Traits:
        """Give the traits of elements in parallel."""
        return reversal_traits(as_memory("masing", self.depth, 0.0), invertible=self.K_inf > 0.0)

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

        Raises
        ------
        NotInvertibleError
            If K_inf is 0: in macro-slip the force stays, wherever the input goes.
        """
        return self._as_masing().exact_inverse()

    def parameters(self) -> Parameters:
        """Give F_S, K_T, chi, beta, K_inf."""
        return self.curve.parameters()

    def with_parameters(self, theta: Sequence[float] | Array) -> Iwan:
        """Give the model of other constants with the same memory."""
        force, stiffness, chi, beta, residual = as_parameter_vector(theta, 5).tolist()
        return Iwan(force, stiffness, chi, beta, residual, self.depth)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants."""
        return self.curve.parameter_scales(input_scale, output_scale)

    def portrait(self) -> Portrait:
        """Show the loading curve."""
        return Portrait(("curve",), self.curve)

    def lipschitz_constant(self) -> float:
        """Give the stiffness at rest plus what sliding takes from it."""
        return self.curve.lipschitz_constant()

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and, where it is unusual, the room for reversals."""
        constants = {name: getattr(self, name) for name in _NAMES}
        room = {} if self.depth == DEPTH else {"depth": self.depth}
        return {"kind": self.kind, **constants, **room}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Iwan:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, _NAMES, ("depth",)))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return self._as_masing().stages()

    def _as_masing(self) -> MasingOperator:
        return MasingOperator(self.curve, "masing", self.depth)

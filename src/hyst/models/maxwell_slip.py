"""The Maxwell-slip model of friction: springs that slide, side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_not_negative
from hyst.errors import InputError, NotInvertibleError
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.models.sliding_elements import as_positive_entries, as_start, require_one_each
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.portrait import Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Traits

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))
_ROUNDING = 1e-12
"""Of a quotient f / k whose f was made from it: ascending up to this share counts as ascending."""


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class MaxwellSlip(Operator):
    """Maxwell-slip friction: ``y = k0 u + sum_i k_i S_i[u]``, S_i the stop of threshold f_i / k_i.

    Each element is a spring of stiffness k_i whose other end slides at a force of f_i. As plays, it
    is ``(k0 + sum_i k_i) u - sum_i k_i F_i[u]``.

    Parameters
    ----------
    k
        Shape (n,), > 0, stiffnesses of the elements, output units per input unit.
    f
        Shape (n,), > 0, forces at which they slide, output units; the ways to sliding ``f_i / k_i``
        ascend.
    k0
        >= 0, stiffness of a spring that never slides, output units per input unit.
    z0
        Shape (n,), positions of the sliders before the first sample, input units; zeros if left
        out.

    Raises
    ------
    InputError
        If lengths differ, a constant is negative, zero where it must not be or not finite, or the
        ways to sliding do not ascend.

    Notes
    -----
    W. D. Iwan, A distributed-element model for hysteresis and its steady-state dynamic response, J.
    Applied Mechanics 33 (1966) 893-900, eq. 1; F. Al-Bender, V. Lampaert and J. Swevers, IEEE
    Trans. Automatic Control 50 (2005) 1883-1887, sec. II.

    Examples
    --------
    >>> friction = MaxwellSlip(k=[2.0, 1.0], f=[1.0, 1.0])
    >>> friction([0.0, 0.25, 2.0, 1.5])
    array([0.  , 0.75, 2.  , 0.5 ])
    """

    k: Array
    f: Array
    k0: float
    z0: Array

    kind = "maxwell-slip"

    def __init__(
        self, k: ArrayLike, f: ArrayLike, k0: float = 0.0, z0: ArrayLike | None = None
    ) -> None:
        stiffness, force = as_positive_entries(k, "k"), as_positive_entries(f, "f")
        require_one_each(force, stiffness, "f", "k")
        _require_ascending(stiffness, force)
        object.__setattr__(self, "k", stiffness)
        object.__setattr__(self, "f", force)
        object.__setattr__(self, "k0", as_not_negative(k0, "k0"))
        object.__setattr__(self, "z0", as_start(z0, stiffness.size, "z0"))

    def as_plays(self) -> PrandtlIshlinskii:
        """Give the same operator as a bank of plays.

        Returns
        -------
        PrandtlIshlinskii
            ``p0 = k0 + sum k``, weights -k and thresholds f / k.
        """
        linear = float(np.cumsum([self.k0, *self.k])[-1])
        r = np.maximum.accumulate(self.f / self.k)
        return PrandtlIshlinskii(-self.k, r, linear, self.z0)

    def traits(self) -> Traits:
        """Give the traits of its plays."""
        return self.as_plays().traits()

    def initial_state(self) -> Array:
        """Give the positions of the sliders, shape (n,)."""
        return self.z0.copy()

    def exact_inverse(self) -> PrandtlIshlinskii:
        """Give the exact inverse, from forces to positions: a Prandtl-Ishlinskii model.

        Raises
        ------
        NotInvertibleError
            If k0 is 0, so that all elements slide at one force, whatever the position; or as for
            ``PrandtlIshlinskii``.
        """
        if self.k0 == 0.0:
            raise NotInvertibleError(
                f"k0 is 0: when all elements slide the force stays at {float(self.f.sum()):.6g}, "
                "so that many positions have one force; give a spring k0 > 0 beside them"
            )
        return self.as_plays().exact_inverse()

    def parameters(self) -> Parameters:
        """Give k0, the stiffnesses, then the forces."""
        n = self.k.size
        return Parameters(
            values=np.concatenate([[self.k0], self.k, self.f]),
            names=("k0", *numbered("k", n), *numbered("f", n)),
            lower=np.concatenate([[0.0], np.full(2 * n, _SMALLEST)]),
            upper=np.full(2 * n + 1, np.inf),
        )

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the vector with ways to sliding that do not fall."""
        n = self.k.size
        nearest, k = theta.copy(), theta[1 : n + 1]
        nearest[n + 1 :] = np.maximum(theta[n + 1 :], k * np.maximum.accumulate(theta[n + 1 :] / k))
        return nearest

    def with_parameters(self, theta: Sequence[float] | Array) -> MaxwellSlip:
        """Give the model of other constants with the same sliders before the first sample."""
        n = self.k.size
        vector = as_parameter_vector(theta, 1 + 2 * n)
        return MaxwellSlip(vector[1 : n + 1], vector[n + 1 :], float(vector[0]), self.z0)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of k0, k and f."""
        n = self.k.size
        return np.repeat([output_scale / input_scale, output_scale], [n + 1, n])

    def in_units(self, input_scale: float, output_scale: float) -> MaxwellSlip:
        """Give the model in other units, its sliders too."""
        ratio = output_scale / input_scale
        return MaxwellSlip(
            self.k * ratio, self.f * output_scale, self.k0 * ratio, self.z0 * input_scale
        )

    def portrait(self) -> Portrait:
        """Show it as its plays."""
        return self.as_plays().portrait()

    def lipschitz_constant(self) -> float:
        """Give ``k0 + 2 sum k``."""
        return self.as_plays().lipschitz_constant()

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and, where there are any, the sliders before the first sample."""
        memory = {"z0": self.z0.tolist()} if self.z0.any() else {}
        return {
            "kind": self.kind,
            "k0": self.k0,
            "k": self.k.tolist(),
            "f": self.f.tolist(),
            **memory,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> MaxwellSlip:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("k", "f", "k0"), optional=("z0",)))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("maxwell_slip", (self.k0, *self.k.tolist(), *self.f.tolist())),)


def _require_ascending(k: Array, f: Array) -> None:
    ways = as_constants(f / k, "f / k")
    wrong = np.flatnonzero(ways[1:] < ways[:-1] * (1.0 - _ROUNDING))
    if wrong.size:
        i = int(wrong[0]) + 1
        raise InputError(
            f"f[{i}] / k[{i}] = {ways[i]:.6g} is smaller than f[{i - 1}] / k[{i - 1}] = "
            f"{ways[i - 1]:.6g}; sort the elements by the way after which they slide"
        )

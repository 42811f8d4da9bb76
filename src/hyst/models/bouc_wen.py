"""Bouc-Wen's model of hysteresis, and its exact inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_number, as_positive
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

LEAST_EXPONENT, LARGEST_EXPONENT = 0.1, 100.0
STEEPEST = 1000.0
"""Of ``dz/du`` in unloading over that at z = 0; further, the kernel's continued fraction is cut."""

_SMALLEST = float(np.nextafter(0.0, 1.0))
_LEAST_NORMAL = float(np.finfo(np.float64).tiny)
_NAMES = ("k", "A", "beta", "gamma", "n", "phi")


@dataclass(frozen=True, eq=False)
class _BoucWen(Operator):
    """What Bouc-Wen's model and its inverse have in common: all constants."""

    k: float
    A: float
    beta: float
    gamma: float
    n: float = 1.0
    h: float = 1.0
    phi: float = 0.0
    z0: float = 0.0
    u0: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "k", as_not_negative(self.k, "k"))
        for name in ("A", "beta"):
            object.__setattr__(self, name, as_positive(getattr(self, name), name))
        object.__setattr__(self, "n", as_positive(self.n, "n", most=LARGEST_EXPONENT))
        for name in ("gamma", "h", "phi", "z0", "u0"):
            object.__setattr__(self, name, as_number(getattr(self, name), name))
        if self.n < LEAST_EXPONENT:
            raise InputError(
                f"n is {self.n:g}; below {LEAST_EXPONENT:g} z is next to a straight line and the "
                f"kernel loses digits, so give {LEAST_EXPONENT:g} to {LARGEST_EXPONENT:g}"
            )
        if self.h not in (1.0, -1.0):
            raise InputError(f"h is {self.h:g}; y = k u + h z, so give 1 or -1")
        self._refuse_what_is_not_admissible()
        low, high = self.limits()
        if not low <= self.z0 <= high:
            raise InputError(
                f"z0 is {self.z0:g}; z stays between its limits, so give {low:.6g} to {high:.6g}"
            )

    def _refuse_what_is_not_admissible(self) -> None:
        if not -self.beta < self.gamma <= self.beta:
            raise InputError(
                f"gamma is {self.gamma:g} where beta is {self.beta:g}; a loop dissipates and keeps "
                "within limits for -beta < gamma <= beta only, so give such constants"
            )
        least = self.beta + self.gamma - 2.0 * abs(self.phi)
        if not least > 0.0:
            raise InputError(
                f"phi is {self.phi:g} where beta + gamma is {self.beta + self.gamma:g}; z has a "
                "limit on either side for 2 |phi| < beta + gamma only, so give a smaller phi"
            )
        if self.beta - self.gamma > STEEPEST * least:
            raise InputError(
                f"(beta - gamma) / (beta + gamma - 2 |phi|) is {(self.beta - self.gamma) / least:g}"
                f"; unloading so much steeper than z = 0 is beyond what is computed, so give at "
                f"most {STEEPEST:g}"
            )

    def limits(self) -> tuple[float, float]:
        """Give what z lies between: ``-(A / (beta + gamma - 2 phi))^(1/n)``, and above.

        Returns
        -------
        low, high : float
        """
        total = self.beta + self.gamma
        low, high = total - 2.0 * self.phi, total + 2.0 * self.phi
        return -((self.A / low) ** (1.0 / self.n)), (self.A / high) ** (1.0 / self.n)

    def slopes(self) -> tuple[float, float]:
        """Give the least and the largest ``dy/du`` over all z between their limits.

        Returns
        -------
        least, largest : float
        """
        least = self.beta + self.gamma - 2.0 * abs(self.phi)
        # Next to a limit z rests in one direction; in the other it is steepest.
        steepest = self.A * (1.0 + (self.beta - self.gamma) / least)
        if self.h > 0.0:
            return self.k, self.k + steepest
        return self.k - steepest, self.k

    def parameters(self) -> Parameters:
        """Give k, A, beta, gamma, n and phi; what beta allows of the others is no box."""
        return Parameters(
            values=np.array([getattr(self, name) for name in _NAMES]),
            names=_NAMES,
            lower=np.array([0.0, _SMALLEST, _SMALLEST, -np.inf, LEAST_EXPONENT, -np.inf]),
            upper=np.array([np.inf, np.inf, np.inf, np.inf, LARGEST_EXPONENT, np.inf]),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the model of other constants with the same state before the first sample."""
        k, a, beta, gamma, n, phi = as_parameter_vector(theta, 6).tolist()
        return type(self)(k, a, beta, gamma, n, self.h, phi, self.z0, self.u0)

    def lipschitz_constant(self) -> float:
        """Give infinity: many small ways move z as one large way does."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and, where they are not 0, phi and the state before the start."""
        rest = {name: getattr(self, name) for name in ("phi", "z0", "u0") if getattr(self, name)}
        constants = {name: getattr(self, name) for name in ("k", "A", "beta", "gamma", "n", "h")}
        return {"kind": self.kind, **constants, **rest}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("k", "A", "beta", "gamma", "n", "h"), ("phi", "z0", "u0")))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is y."""

    def _all(self) -> tuple[float, ...]:
        return (self.k, self.A, self.beta, self.gamma, self.n, self.h, self.phi, self.z0, self.u0)

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        constants = tuple(float(each) for each in self.parameters().values)
        choices = {"inverse": int(self._is_inverse())}
        return (Stage("bouc_wen", constants, fixed={"h": (self.h,)}, choices=choices),)


@register
@final
@dataclass(frozen=True, eq=False)
class BoucWen(_BoucWen):
    """Bouc-Wen's model: ``y = k u + h z``, ``dz = (A - |z|^n (beta sgn(z du) + gamma)) du``.

    With phi the bracket is ``beta sgn(z du) + gamma + phi (sgn(du) + sgn(z))``. Exact between
    samples: the way is counted from the last turn, and way and z determine each other by a
    quadrature (a logarithm for n = 1, a hypergeometric function otherwise).

    Parameters
    ----------
    k
        >= 0, output units per input unit; alpha k_i in mechanics, d of a piezo.
    A
        > 0, slope of z at z = 0, output units per input unit; (1 - alpha) k_i in mechanics.
    beta, gamma
        beta > 0, ``-beta < gamma <= beta``, per input unit and ``(output unit)^(n - 1)``.
    n
        Sharpness of the way to the limit, 0.1 to 100.
    h
        1 (mechanics: a loop that softens after a turn) or -1 (piezos: one that stiffens).
    phi
        ``2 |phi| < beta + gamma``: limits of z are ``(A / (beta + gamma +- 2 phi))^(1/n)``.
    z0, u0
        State before the first sample: z, output units, within its limits, and input.

    Raises
    ------
    InputError
        If constants are not finite, or not admissible: the sentence names the value.

    Notes
    -----
    R. Bouc, Acustica 24 (1971) 16-25; Y.-K. Wen, J. Eng. Mech. Div. ASCE 102 (1976) 249-263, eq. 2.
    Admissible constants: S. Erlicher and N. Point, C. R. Mecanique 332 (2004) 51-57; F. Ikhouane,
    V. Manosa and J. Rodellar, Systems & Control Letters 56 (2007) 197-205. phi: C.-H. Wang and
    Y.-K. Wen (1998), as given by J. Song and A. Der Kiureghian, J. Eng. Mech. 132 (2006) 610-618.
    Loops do not close after minor loops: the model has no return-point memory.

    Examples
    --------
    >>> piezo = BoucWen(k=0.6, A=0.35, beta=0.012, gamma=0.006, h=-1.0)
    >>> y = piezo([0.0, 40.0, 0.0])
    >>> y.round(6)
    array([ 0.      , 14.020183,  4.243657])
    >>> (piezo.inverse()(y) - [0.0, 40.0, 0.0]).round(12) + 0.0
    array([0., 0., 0.])
    """

    kind = "bouc-wen"

    def initial_state(self) -> Array:
        """Give u and z, before the first sample and at a turn, shape (4,)."""
        return np.array([self.u0, self.z0, self.u0, self.z0])

    def traits(self) -> Traits:
        """Give the traits: z is that of the way since the last turn, to the bit."""
        least = self.slopes()[0]
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=least >= 0.0,
            invertible=least > 0.0,
        )

    def exact_inverse(self) -> InverseBoucWen:
        """Give the exact inverse, from y to u.

        Raises
        ------
        NotInvertibleError
            If y does not rise with u for every z that is possible: the sentence gives the least
            slope.
        """
        least = self.slopes()[0]
        if not least > 0.0:
            where = (
                "k - A (1 + (beta - gamma) / (beta + gamma - 2 |phi|)), right after a turn"
                if self.h < 0.0
                else "k, at the limit of z"
            )
            raise NotInvertibleError(
                f"the smallest slope dy/du is {least:.6g}, {where}: many inputs have one output, "
                "so that there is no inverse"
            )
        return InverseBoucWen(*self._all())

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of k, A, beta, gamma, n and phi.

        Raises
        ------
        InputError
            If beta would be beyond the range of numbers, as for a large n and a small output.
        """
        slope = output_scale / input_scale
        hold = _power(output_scale, 1.0 - self.n) / input_scale
        if not _LEAST_NORMAL <= self.beta * hold < np.inf:
            raise InputError(
                f"n is {self.n:g}: beta and gamma go with the power {1.0 - self.n:g} of the "
                f"output's unit, and times {output_scale:g} they leave the range of numbers; give "
                "an output of moderate size or a smaller n"
            )
        return np.array([slope, slope, hold, hold, 1.0, hold])

    def in_units(self, input_scale: float, output_scale: float) -> BoucWen:
        """Give the model in other units, its state before the first sample too."""
        scales = self.parameter_scales(input_scale, output_scale)
        k, a, beta, gamma, n, phi = (self.parameters().values * scales).tolist()
        z0, u0 = self.z0 * output_scale, self.u0 * input_scale
        return BoucWen(k, a, beta, gamma, n, self.h, phi, z0, u0)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False)
class InverseBoucWen(_BoucWen):
    """Inverse of Bouc-Wen's model, from y to u; ``BoucWen.inverse()`` makes it.

    Parameters
    ----------
    k, A, beta, gamma, n, h, phi, z0, u0
        As in ``BoucWen``.

    Raises
    ------
    InputError
        As ``BoucWen``, and if its smallest slope ``dy/du`` is not above 0.

    Examples
    --------
    >>> BoucWen(k=1.0, A=2.0, beta=0.5, gamma=0.5).inverse()([1.0, 0.0]).round(6)
    array([0.374823, 0.041345])
    """

    kind = "inverse-bouc-wen"

    def __post_init__(self) -> None:
        super().__post_init__()
        least = self.slopes()[0]
        if not least > 0.0:
            raise InputError(
                f"the smallest slope dy/du is {least:.6g}; an inverse needs one above 0, so give "
                "a larger k"
            )

    def initial_state(self) -> Array:
        """Give u and z before the first sample, both at a turn, and both y, shape (6,)."""
        y0 = self.k * self.u0 + self.h * self.z0
        return np.array([self.u0, self.z0, self.u0, self.z0, y0, y0])

    def traits(self) -> Traits:
        """Give the traits of an input that a rising output determines."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=True,
            invertible=True,
        )

    def exact_inverse(self) -> BoucWen:
        """Give the model."""
        return BoucWen(*self._all())

    def _is_inverse(self) -> bool:
        return True


def _power(base: float, exponent: float) -> float:
    """Give a power, infinity where it has no number."""
    try:
        return float(base**exponent)
    except OverflowError:
        return float("inf")

"""The hysteresis of Jiles and Atherton in its variants, and its inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_positive
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

MOST_UNEQUAL = 1000.0
"""Of k / a, or its reciprocal: a sample takes up to 2400 times as many sub-steps."""
VARIANTS = ("effective-field", "jiles-thoelke-devine-1992", "jiles-atherton-1986")
MAGNETISATION, FLUX_DENSITY = "M", "B"
MAGNETIC_CONSTANT = 4e-7 * np.pi
"""mu0, in T per A/m."""

_SMALLEST = float(np.nextafter(0.0, 1.0))
_BELOW_ONE = float(np.nextafter(1.0, 0.0))


@dataclass(frozen=True, eq=False)
class _Magnet(Operator):
    """What the model and its inverse have in common: all constants."""

    Ms: float
    a: float
    k: float
    c: float
    alpha: float
    variant: str = VARIANTS[0]
    output: str = MAGNETISATION
    mu0: float = MAGNETIC_CONSTANT

    def __post_init__(self) -> None:
        for name in ("Ms", "a", "k", "mu0"):
            object.__setattr__(self, name, as_positive(getattr(self, name), name))
        for name in ("c", "alpha"):
            object.__setattr__(self, name, as_not_negative(getattr(self, name), name))
        if self.c >= 1.0:
            raise InputError(
                f"c is {self.c:.6g}; it is the reversible share, so give 0 to less than 1"
            )
        for name, choices in (("variant", VARIANTS), ("output", (MAGNETISATION, FLUX_DENSITY))):
            if getattr(self, name) not in choices:
                raise InputError(
                    f"{name} is {getattr(self, name)!r}; choose one of {', '.join(choices)}"
                )
        if not 1.0 / MOST_UNEQUAL <= self.k / self.a <= MOST_UNEQUAL:
            raise InputError(
                f"k / a is {self.k / self.a:.6g}; a sample would take millions of sub-steps, so "
                f"give 1/{MOST_UNEQUAL:g} to {MOST_UNEQUAL:g}"
            )
        if self.coupling >= 1.0:
            raise InputError(
                f"alpha Ms / (3 a) is {self.coupling:.6g}; from 1 on the magnetisation jumps, for "
                "one field has several, so give a smaller alpha or a larger a"
            )

    @property
    def coupling(self) -> float:
        """How far it is to a jump: ``alpha Ms / (3 a)``, below 1."""
        return self.alpha * self.Ms / (3.0 * self.a)

    def initial_state(self) -> Array:
        """Give the demagnetised state, shape (8,): zeros."""
        return np.zeros(8)

    def parameters(self) -> Parameters:
        """Give Ms, a, k, c and alpha."""
        return Parameters(
            values=np.array([self.Ms, self.a, self.k, self.c, self.alpha]),
            names=("Ms", "a", "k", "c", "alpha"),
            lower=np.array([_SMALLEST, _SMALLEST, _SMALLEST, 0.0, 0.0]),
            upper=np.array([np.inf, np.inf, np.inf, _BELOW_ONE, np.inf]),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the model of other constants, of the same variant and output."""
        saturation, a, k, c, alpha = as_parameter_vector(theta, 5).tolist()
        return replace(self, Ms=saturation, a=a, k=k, c=c, alpha=alpha)

    def lipschitz_constant(self) -> float:
        """Give infinity: many small ways magnetise as one large way does."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants, variant, output, and mu0 where the output is B."""
        constants = {name: getattr(self, name) for name in ("Ms", "a", "k", "c", "alpha")}
        flux = {"mu0": self.mu0} if self.output == FLUX_DENSITY else {}
        names = {"variant": self.variant, "output": self.output}
        return {"kind": self.kind, **constants, **names, **flux}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("Ms", "a", "k", "c", "alpha", "variant", "output"), ("mu0",)))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is M or B."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        constants = (self.Ms, self.a, self.k, self.c, self.alpha)
        flux = int(self.output == FLUX_DENSITY)
        choices = {"flux": flux, "inverse": int(self._is_inverse())}
        fixed = {"mu0": (self.mu0,)}
        return (Stage("jiles_atherton", constants, fixed, choices, self.variant),)


@register
@final
@dataclass(frozen=True, eq=False)
class JilesAtherton(_Magnet):
    """Jiles and Atherton's magnet: M lags ``Man = Ms L((H + alpha M) / a)``, L(x) = coth x - 1/x.

    With ``He = H + alpha M``, ``s = sgn(dH)`` and the pinned part Mirr, which rests where it would
    move away from Man (delta_M), the variants are

    ``"effective-field"``
        ``M = c Man + (1 - c) Mirr``, ``dMirr/dHe = (Man - Mirr) / (s k)``; so ``dM/dH = chi / (1 -
        alpha chi)``, ``chi = (1 - c) dMirr/dHe + c dMan/dHe``.
    ``"jiles-thoelke-devine-1992"``
        ``M = c Man + (1 - c) Mirr``, ``dMirr/dH = (Man - Mirr) / (s k - alpha (Man - Mirr))``.
    ``"jiles-atherton-1986"``
        ``dM/dH = ((Man - M) / (s k - alpha (Man - M)) + c dMan/dH) / (1 + c)``.

    dMan/dH is the whole derivative, ``dMan/dHe (1 + alpha dM/dH)``. For alpha = 0 the first two are
    one; else the same constants give other loops. M starts from 0, demagnetised.

    Parameters
    ----------
    Ms
        > 0, saturation, in the unit of M: what M approaches.
    a
        > 0, shape of the anhysteretic curve, in the unit of H.
    k
        > 0, pinning, in the unit of H: near the coercive field of what is magnetised far.
    c
        0 to less than 1, the reversible share.
    alpha
        >= 0, coupling, unit of H per unit of M; ``alpha Ms < 3 a``, or M would jump.
    variant
        See above.
    output
        ``"M"``, or ``"B"`` for ``mu0 (H + M)``, M in the unit of H then.
    mu0
        Unit of B per unit of H; that of T and A/m unless told otherwise. It is no parameter.

    Raises
    ------
    InputError
        If a constant is out of its range, ``k / a`` is beyond 1/1000 to 1000, or
        ``alpha Ms / (3 a)`` is 1 or more.

    Notes
    -----
    D. C. Jiles and D. L. Atherton, Theory of ferromagnetic hysteresis, J. Magn. Magn. Mater. 61
    (1986) 48-60. D. C. Jiles, J. B. Thoelke and M. K. Devine, Numerical determination of hysteresis
    parameters, IEEE Trans. Magn. 28 (1992) 27-35. R. Venkataraman, Modeling and adaptive control of
    magnetostrictive actuators, PhD thesis, Maryland (1999), whose equation is that of the effective
    field. What they disagree about: S. E. Zirka et al., On physical aspects of the Jiles-Atherton
    hysteresis models, J. Appl. Phys. 112 (2012) 043916. Minor loops do not close.

    Examples
    --------
    >>> magnet = JilesAtherton(Ms=1.0, a=1.0, k=0.5, c=0.2, alpha=1.0)
    >>> magnet([2.0, 0.5]).round(6)
    array([0.552766, 0.365048])
    >>> magnet.inverse()(magnet([2.0, 0.5])).round(12)
    array([2. , 0.5])
    """

    kind = "jiles-atherton"

    def traits(self) -> Traits:
        """Give the traits: the output is that of the field since the last turn, to the bit."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=True,
            invertible=self.is_invertible,
        )

    def exact_inverse(self) -> InverseJilesAtherton:
        """Give the inverse, from M or B to H, solved along the branch to rounding.

        A magnetisation of Ms or more has no field; ``run`` names its sample, a stepper holds its
        last output and raises its flag.

        Raises
        ------
        NotInvertibleError
            If the output is M and c is 0: right after a turn M rests.
        """
        if self.c == 0.0 and self.output == MAGNETISATION:
            raise NotInvertibleError(
                "c is 0: right after a turn dM/dH is 0 until the field has come back to the "
                "anhysteretic curve, so that many fields have one M; give a c above 0, or "
                "output='B', which always moves with the field"
            )
        return InverseJilesAtherton(
            self.Ms, self.a, self.k, self.c, self.alpha, self.variant, self.output, self.mu0
        )

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of Ms, a, k, c and alpha."""
        magnetisation = input_scale if self.output == FLUX_DENSITY else output_scale
        coupling = input_scale / magnetisation
        return np.array([magnetisation, input_scale, input_scale, 1.0, coupling])

    def in_units(self, input_scale: float, output_scale: float) -> JilesAtherton:
        """Give the model in other units, mu0 too where the output is B."""
        values = self.parameter_scales(input_scale, output_scale) * self.parameters().values
        is_flux = self.output == FLUX_DENSITY
        mu0 = self.mu0 * (output_scale / input_scale) if is_flux else self.mu0
        return replace(self.with_parameters(values), mu0=mu0)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False)
class InverseJilesAtherton(_Magnet):
    """Inverse of Jiles and Atherton's magnet, from M or B to H.

    Parameters
    ----------
    Ms, a, k, c, alpha, variant, output, mu0
        As in ``JilesAtherton``, which makes it.

    Raises
    ------
    InputError
        As ``JilesAtherton``, and if c is 0 and the output M.

    Examples
    --------
    >>> JilesAtherton(1.0, 1.0, 0.5, 0.2, 1.0).inverse()([0.552766, 0.365048]).round(5)
    array([2. , 0.5])
    """

    kind = "inverse-jiles-atherton"

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.c == 0.0 and self.output == MAGNETISATION:
            raise InputError("c is 0, where M rests after a turn and has no inverse; give c > 0")

    def traits(self) -> Traits:
        """Give the traits of a field that the output determines."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=True,
            invertible=True,
        )

    def exact_inverse(self) -> JilesAtherton:
        """Give the magnet."""
        return JilesAtherton(
            self.Ms, self.a, self.k, self.c, self.alpha, self.variant, self.output, self.mu0
        )

    def _is_inverse(self) -> bool:
        return True

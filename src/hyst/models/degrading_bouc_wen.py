"""Bouc-Wen's model whose strength and stiffness degrade and whose loops pinch, and its inverse."""

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

SHARPEST = 20.0
"""Of n: a width of a sub-step goes with 1 / n."""
STEEPEST = 1000.0
"""Of ``dz/du`` in unloading over that at z = 0."""
NARROWEST = 1e-3
"""Of a pinch over the limit of z: a branch takes some ten sub-steps of its width."""

_SMALLEST = float(np.nextafter(0.0, 1.0))
_BELOW_ONE = float(np.nextafter(1.0, 0.0))
_LOOP = ("k", "A", "beta", "gamma", "n")
_WEAR = ("delta_nu", "delta_eta")
_PINCH = ("zeta", "p", "q", "psi", "delta_psi", "lam")
_NAMES = (*_LOOP, *_WEAR, *_PINCH)


@dataclass(frozen=True, eq=False)
class _Degrading(Operator):
    """What the model and its inverse have in common: all constants."""

    k: float
    A: float
    beta: float
    gamma: float
    n: float = 1.0
    delta_nu: float = 0.0
    delta_eta: float = 0.0
    zeta: float = 0.0
    p: float = 0.0
    q: float = 0.0
    psi: float = 1.0
    delta_psi: float = 0.0
    lam: float = 1.0

    def __post_init__(self) -> None:
        for name in ("k", "delta_nu", "delta_eta", "zeta", "p", "q", "delta_psi"):
            object.__setattr__(self, name, as_not_negative(getattr(self, name), name))
        for name in ("A", "beta", "psi", "lam"):
            object.__setattr__(self, name, as_positive(getattr(self, name), name))
        object.__setattr__(self, "gamma", as_number(self.gamma, "gamma"))
        object.__setattr__(self, "n", as_positive(self.n, "n", most=SHARPEST))
        if self.n < 1.0:
            raise InputError(
                f"n is {self.n:g}; loops that degrade are computed for 1 to {SHARPEST:g}, so give "
                "no less than 1"
            )
        if self.zeta >= 1.0:
            raise InputError(
                f"zeta is {self.zeta:.6g}; a loop pinched as deep as 1 stands still, so give 0 to "
                "less than 1"
            )
        self._refuse_what_is_not_admissible()

    def _refuse_what_is_not_admissible(self) -> None:
        if not -self.beta < self.gamma <= self.beta:
            raise InputError(
                f"gamma is {self.gamma:g} where beta is {self.beta:g}; a loop dissipates and keeps "
                "within limits for -beta < gamma <= beta only, so give such constants"
            )
        total = self.beta + self.gamma
        if self.beta - self.gamma > STEEPEST * total:
            raise InputError(
                f"(beta - gamma) / (beta + gamma) is {(self.beta - self.gamma) / total:g}; "
                f"unloading so much steeper than z = 0 is beyond what is computed, so give at most "
                f"{STEEPEST:g}"
            )
        width = self.psi * self.lam / self.limit()
        if self.zeta > 0.0 and width < NARROWEST:
            raise InputError(
                f"psi lam is {width:.6g} of the limit of z, {self.limit():.6g}; so narrow a pinch "
                f"would take too many sub-steps, so give a psi or lam with at least {NARROWEST:g}"
            )

    def limit(self) -> float:
        """Give what |z| stays below: ``(A / (beta + gamma))^(1/n)``, that of the new model.

        Returns
        -------
        float
            Output units.
        """
        return float((self.A / (self.beta + self.gamma)) ** (1.0 / self.n))

    def least_slope(self) -> float:
        """Give what ``dy/du`` never falls below: ``k - delta_nu limit^2 / (n (1 - zeta))``.

        While the limit of z shrinks with the energy, z at its limit falls along a way that goes on
        at most so fast. Without loss of strength the bound is k.

        Returns
        -------
        float
        """
        return self.k - self.delta_nu * self.limit() ** 2 / (self.n * (1.0 - self.zeta))

    def initial_state(self) -> Array:
        """Give zeros: no input, no z and no energy yet."""
        return np.zeros(9 if self._is_inverse() else 7)

    def parameters(self) -> Parameters:
        """Give the constants in the order of the constructor."""
        low = {"k": 0.0, "gamma": -np.inf, "n": 1.0, "zeta": 0.0, "p": 0.0, "q": 0.0}
        low |= dict.fromkeys(("delta_nu", "delta_eta", "delta_psi"), 0.0)
        high = {"n": SHARPEST, "zeta": _BELOW_ONE}
        return Parameters(
            values=np.array(self._constants()),
            names=_NAMES,
            lower=np.array([low.get(name, _SMALLEST) for name in _NAMES]),
            upper=np.array([high.get(name, np.inf) for name in _NAMES]),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the model of other constants."""
        return type(self)(*as_parameter_vector(theta, len(_NAMES)).tolist())

    def lipschitz_constant(self) -> float:
        """Give infinity: many small ways wear a model out as one large way does not."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind and constants; of wear and pinch those that are not as they are left out."""
        usual = dict.fromkeys((*_WEAR, *_PINCH), 0.0) | {"psi": 1.0, "lam": 1.0}
        given = {name: getattr(self, name) for name in _LOOP}
        rest = {name: getattr(self, name) for name in usual if getattr(self, name) != usual[name]}
        return {"kind": self.kind, **given, **rest}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, _LOOP, (*_WEAR, *_PINCH)))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is y."""

    def _constants(self) -> tuple[float, ...]:
        return tuple(float(getattr(self, name)) for name in _NAMES)

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {"inverse": int(self._is_inverse())}
        return (Stage("degrading_bouc_wen", self._constants(), choices=choices),)


@register
@final
@dataclass(frozen=True, eq=False)
class DegradingBoucWen(_Degrading):
    """Bouc-Wen's model that wears out with the energy it absorbs, and whose loops pinch.

        y = k u + z,   e = integral of z du
        dz = h(z, e) (A - nu |z|^n (beta sgn(z du) + gamma)) / eta du
        nu = 1 + delta_nu e,   eta = 1 + delta_eta e
        h = 1 - zeta1 exp(-((z sgn(du) - q z_u) / zeta2)^2),   z_u = (A / (nu (beta + gamma)))^(1/n)
        zeta1 = zeta (1 - exp(-p e)),   zeta2 = (psi + delta_psi e) (lam + zeta1)

    The energy follows from the way, whatever the rate. It starts from rest: u, z and e are 0.

    Parameters
    ----------
    k
        >= 0, output units per input unit; alpha k_i in mechanics.
    A
        > 0, slope of z at z = 0, output units per input unit; (1 - alpha) k_i in mechanics.
    beta, gamma
        beta > 0, ``-beta < gamma <= beta``, per input unit and ``(output unit)^(n - 1)``.
    n
        Sharpness of the way to the limit, 1 to 20.
    delta_nu
        >= 0, loss of strength, per unit of energy (input unit times output unit).
    delta_eta
        >= 0, loss of stiffness, per unit of energy.
    zeta
        0 to less than 1, how deep loops pinch in the end: stiffness falls to 1 - zeta.
    p
        >= 0, how quickly they come to pinch, per unit of energy.
    q
        >= 0, where loops pinch, as a share of the limit of z.
    psi
        > 0, width of the pinch, output units.
    delta_psi
        >= 0, by how much it widens, output units per unit of energy.
    lam
        > 0, how much of its final width a pinch has when it begins.

    Raises
    ------
    InputError
        If constants are not finite, or not admissible: the sentence names the value.

    Notes
    -----
    T. T. Baber and Y.-K. Wen, J. Eng. Mech. Div. ASCE 107 (1981) 1069-1087 (nu, eta); T. T. Baber
    and M. N. Noori, J. Vib. Acoust. 108 (1986) 411-420, and G. C. Foliente, J. Struct. Eng. 121
    (1995) 1013-1022, eqs. 5-16 (h).

    Examples
    --------
    >>> joint = DegradingBoucWen(k=0.1, A=0.9, beta=0.5, gamma=0.4, delta_nu=0.02, zeta=0.5, p=1.0)
    >>> y = joint([1.0, -1.0, 1.0])
    >>> y.round(4)
    array([ 0.6757, -0.7494,  0.672 ])
    >>> (joint.inverse()(y) - [1.0, -1.0, 1.0]).round(12) + 0.0
    array([0., 0., 0.])
    """

    kind = "degrading-bouc-wen"

    def traits(self) -> Traits:
        """Give the traits: z and energy are those of the way since the last turn, to the bit."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=self.least_slope() >= 0.0,
            invertible=self.least_slope() > 0.0,
        )

    def exact_inverse(self) -> InverseDegradingBoucWen:
        """Give the exact inverse, from y to u, sample by sample.

        Raises
        ------
        NotInvertibleError
            If y might fall while u rises: the sentence gives the bound of the slope.
        """
        least = self.least_slope()
        if not least > 0.0:
            raise NotInvertibleError(
                f"the slope dy/du may come down to {least:.6g}, "
                "k - delta_nu limit^2 / (n (1 - zeta)), where strength is lost faster than k makes "
                "up for: many inputs have one output, so that there is no inverse"
            )
        return InverseDegradingBoucWen(*self._constants())

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants.

        Raises
        ------
        InputError
            If beta would be beyond the range of numbers, as for a large n and a small output.
        """
        slope, energy = output_scale / input_scale, output_scale * input_scale
        hold = float(np.float64(output_scale) ** (1.0 - self.n)) / input_scale
        if not np.finfo(np.float64).tiny <= self.beta * hold < np.inf:
            raise InputError(
                f"n is {self.n:g}: beta and gamma go with the power {1.0 - self.n:g} of the "
                f"output's unit, and times {output_scale:g} they leave the range of numbers; give "
                "an output of moderate size or a smaller n"
            )
        loop = [slope, slope, hold, hold, 1.0]
        pinch = [1.0, 1.0 / energy, 1.0, output_scale, 1.0 / input_scale, 1.0]
        return np.array([*loop, 1.0 / energy, 1.0 / energy, *pinch])

    def in_units(self, input_scale: float, output_scale: float) -> DegradingBoucWen:
        """Give the model in other units."""
        scales = self.parameter_scales(input_scale, output_scale)
        return self.with_parameters(self.parameters().values * scales)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False)
class InverseDegradingBoucWen(_Degrading):
    """Inverse of ``DegradingBoucWen``, from y to u; its ``inverse()`` makes it.

    Parameters
    ----------
    k, A, beta, gamma, n, delta_nu, delta_eta, zeta, p, q, psi, delta_psi, lam
        As in ``DegradingBoucWen``.

    Raises
    ------
    InputError
        As ``DegradingBoucWen``, and if the bound of its slope ``dy/du`` is not above 0.

    Examples
    --------
    >>> DegradingBoucWen(k=0.1, A=0.9, beta=0.5, gamma=0.4).inverse()([0.69343, 0.1]).round(4)
    array([1.    , 0.4251])
    """

    kind = "inverse-degrading-bouc-wen"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.least_slope() > 0.0:
            raise InputError(
                f"the slope dy/du may come down to {self.least_slope():.6g}; an inverse needs it "
                "above 0, so give a larger k or a smaller delta_nu"
            )

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

    def exact_inverse(self) -> DegradingBoucWen:
        """Give the model."""
        return DegradingBoucWen(*self._constants())

    def _is_inverse(self) -> bool:
        return True

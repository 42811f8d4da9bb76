"""Dahl's model of friction before sliding, and its exact inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_positive
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))


@dataclass(frozen=True, eq=False)
class _Friction(Operator):
    """What Dahl's model and its inverse have in common: all constants."""

    sigma: float
    Fc: float
    n: float = 1.0
    z0: float = 0.0
    u0: float = 0.0

    def __post_init__(self) -> None:
        for name in ("sigma", "Fc", "n"):
            object.__setattr__(self, name, as_positive(getattr(self, name), name))
        for name in ("z0", "u0"):
            object.__setattr__(self, name, as_number(getattr(self, name), name))
        if not -1.0 <= self.z0 <= 1.0:
            raise InputError(
                f"z0 is {self.z0}; the force before the first sample is a share of Fc, so give "
                "-1 to 1"
            )

    def initial_state(self) -> Array:
        """Give position and share of Fc, before the first sample and at a turn, shape (4,)."""
        return np.array([self.u0, self.z0, self.u0, self.z0])

    def parameters(self) -> Parameters:
        """Give sigma, Fc and n."""
        return Parameters(
            values=np.array([self.sigma, self.Fc, self.n]),
            names=("sigma", "Fc", "n"),
            lower=np.full(3, _SMALLEST),
            upper=np.full(3, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the model of other constants with the same state before the first sample."""
        sigma, force, n = as_parameter_vector(theta, 3).tolist()
        return type(self)(sigma, force, n, self.z0, self.u0)

    def lipschitz_constant(self) -> float:
        """Give infinity: many small ways wear the force down as one large way does."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and, where there is one, the state before the first sample."""
        state = {name: getattr(self, name) for name in ("z0", "u0") if getattr(self, name)}
        return {"kind": self.kind, "sigma": self.sigma, "Fc": self.Fc, "n": self.n, **state}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("sigma", "Fc", "n"), ("z0", "u0")))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is the force."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        constants = (self.sigma, self.Fc, self.n)
        return (Stage("dahl", constants, choices={"inverse": int(self._is_inverse())}),)


@register
@final
@dataclass(frozen=True, eq=False)
class Dahl(_Friction):
    """Dahl's friction: ``dF/du = sigma |1 - s F/Fc|^n sgn(1 - s F/Fc)``, s = sgn(du).

    Exact between samples: with ``w = 1 - s F/Fc`` a way x leaves ``w exp(-sigma x / Fc)`` for n = 1
    and ``w (1 + (n - 1) sigma x / Fc w^(n-1))^(1/(1-n))`` otherwise.

    Parameters
    ----------
    sigma
        > 0, stiffness at rest, output units per input unit.
    Fc
        > 0, Coulomb force, output units: what the force approaches in sliding.
    n
        > 0, shape: 1 is Dahl's first form, an exponential; below 1 sliding begins after a finite
        way, as in ductile materials.
    z0
        Share of Fc before the first sample, -1 to 1.
    u0
        Position before the first sample, input units.

    Raises
    ------
    InputError
        If a constant is not positive and finite, or a share beyond 1.

    Notes
    -----
    P. R. Dahl, A solid friction model, Aerospace Corp. TOR-0158(3107-18)-1 (1968), eq. 4; Solid
    friction damping of mechanical vibrations, AIAA J. 14 (1976) 1675-1682. Loops do not close after
    minor loops: the model has no return-point memory.

    Examples
    --------
    >>> friction = Dahl(sigma=2.0, Fc=1.0)
    >>> friction([0.0, 0.5, 0.0]).round(6)
    array([ 0.      ,  0.632121, -0.399576])
    >>> friction.inverse()(friction([0.0, 0.5, 0.0])).round(12)
    array([0. , 0.5, 0. ])
    """

    kind = "dahl"

    def traits(self) -> Traits:
        """Give the traits: the force is that of the way since the last turn, to the bit."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=True,
            invertible=self.n >= 1.0,
        )

    def exact_inverse(self) -> InverseDahl:
        """Give the exact inverse, from forces smaller than Fc to positions.

        A force of Fc or more has no position; ``run`` names its sample, a stepper holds its last
        output and raises its flag. What is within rounding of Fc has lost its position: after a way
        of x the inverse multiplies errors by ``exp(sigma x / Fc)`` for n = 1.

        Raises
        ------
        NotInvertibleError
            If n is below 1: sliding keeps the force, whatever the position.
        """
        if self.n < 1.0:
            raise NotInvertibleError(
                f"n is {self.n:.6g}: below 1 the force reaches Fc after a finite way and stays "
                "there, so that many positions have one force"
            )
        return InverseDahl(self.sigma, self.Fc, self.n, self.z0, self.u0)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of sigma, Fc and n."""
        return np.array([output_scale / input_scale, output_scale, 1.0])

    def in_units(self, input_scale: float, output_scale: float) -> Dahl:
        """Give the model in other units, its position before the first sample too."""
        sigma, force = self.sigma * (output_scale / input_scale), self.Fc * output_scale
        return Dahl(sigma, force, self.n, self.z0, self.u0 * input_scale)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False)
class InverseDahl(_Friction):
    """Inverse of Dahl's friction, from force to position; ``Dahl.inverse()`` makes it.

    Parameters
    ----------
    sigma, Fc, n, z0, u0
        As in ``Dahl``.

    Raises
    ------
    InputError
        As ``Dahl``.

    Examples
    --------
    >>> Dahl(sigma=2.0, Fc=1.0).inverse()([0.5, -0.5]).round(6)
    array([ 0.346574, -0.202733])
    """

    kind = "inverse-dahl"

    def traits(self) -> Traits:
        """Give the traits of a position that a force within its limits determines."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=True,
            invertible=True,
        )

    def exact_inverse(self) -> Dahl:
        """Give the friction."""
        return Dahl(self.sigma, self.Fc, self.n, self.z0, self.u0)

    def _is_inverse(self) -> bool:
        return True

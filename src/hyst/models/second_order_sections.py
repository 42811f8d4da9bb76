"""Linear dynamics as a cascade of second-order sections."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, as_reals, refuse_overflow
from hyst.checks.numbers import as_sample_time
from hyst.errors import InputError, NotInvertibleError
from hyst.models.linear_dynamics import LinearDynamics
from hyst.models.realizations import cascade, sections_of
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_NAMES = ("b0", "b1", "b2", "a1", "a2")


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class SecondOrderSections(Operator):
    """A cascade of ``(b0 + b1 q^-1 + b2 q^-2) / (1 + a1 q^-1 + a2 q^-2)``.

    Of high order this is quicker and more accurate than a state space, in single precision above
    all.

    Parameters
    ----------
    coefficients
        Shape (count, 5) or (5 count,): b0 b1 b2 a1 a2 of each section, in the order the signal
        passes them.
    dt
        Sample time, s, > 0.

    Raises
    ------
    InputError
        If the shape is another one, a number is not finite, or dt is not positive.

    Examples
    --------
    >>> SecondOrderSections([0.0, 0.5, 0.0, -0.5, 0.0], dt=1e-3)([1.0, 1.0, 1.0]).tolist()
    [0.0, 0.5, 0.75]
    """

    coefficients: Array
    _dt: float

    kind = "second-order-sections"

    def __init__(self, coefficients: ArrayLike, dt: float) -> None:
        flat = as_constants(as_reals(coefficients, "coefficients").ravel(), "coefficients")
        if flat.size == 0 or flat.size % 5:
            raise InputError(f"there are {flat.size} coefficients; give b0 b1 b2 a1 a2 a section")
        table = flat.reshape(-1, 5)
        table.flags.writeable = False
        object.__setattr__(self, "coefficients", table)
        object.__setattr__(self, "_dt", as_sample_time(dt))

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self._dt

    @classmethod
    def from_linear(cls, dynamics: LinearDynamics) -> SecondOrderSections:
        """Write a state space as sections.

        Parameters
        ----------
        dynamics
            Without delay; its initial state is not kept.

        Returns
        -------
        SecondOrderSections

        Raises
        ------
        InputError
            If the system is delayed.

        Examples
        --------
        >>> G = LinearDynamics.from_transfer_function([1.0, 0.2], [1.0, -1.2, 0.5], dt=1.0)
        >>> same = SecondOrderSections.from_linear(G)
        >>> bool(np.abs(same(np.ones(50)) - G(np.ones(50))).max() < 1e-13)
        True
        """
        if dynamics.delay:
            raise InputError(
                f"the system is delayed by {dynamics.delay} samples, which sections are not made "
                "for; take the delay out and compose it"
            )
        lead = dynamics.impulse_response(dynamics.order + 1)
        degree = dynamics.relative_degree()
        gain = float(lead[degree]) if degree <= dynamics.order else 0.0
        zeros = dynamics.zeros()
        return cls(sections_of(zeros, dynamics.poles(), gain), dynamics.dt)

    def linear(self) -> LinearDynamics:
        """Give the state space of the same system."""
        return LinearDynamics(*cascade(self.coefficients), self.dt)

    def traits(self) -> Traits:
        """Give the traits of a linear system with memory."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=False,
            invertible=self.is_invertible,
        )

    def initial_state(self) -> Array:
        """Give zeros, two for each section."""
        return np.zeros(2 * len(self.coefficients))

    def exact_inverse(self) -> SecondOrderSections:
        """Give the causal inverse: numerators and denominators change places.

        Raises
        ------
        NotInvertibleError
            If a section does not answer at once, or has a zero not inside the unit circle; use
            ``hyst.models.StableInverse`` for a whole trajectory then.
        """
        b, a = self.coefficients[::-1, :3], self.coefficients[::-1, 3:]
        for number, row in enumerate(b):
            if not _has_zeros_inside(*row.tolist()):
                raise NotInvertibleError(
                    f"section {len(b) - number} has the numerator {row.tolist()}, whose causal "
                    "inverse is not stable; use hyst.models.StableInverse, which looks ahead, on "
                    "whole trajectories"
                )
        with np.errstate(all="ignore"):
            gain = 1.0 / b[:, :1]
            swapped = np.hstack([gain, a * gain, b[:, 1:] * gain])
        refuse_overflow(swapped)
        return SecondOrderSections(swapped, self.dt)

    def parameters(self) -> Parameters:
        """Give b0 b1 b2 a1 a2 of each section."""
        values = self.coefficients.ravel()
        count = len(self.coefficients)
        names = tuple(f"{name}[{i}]" for i in range(1, count + 1) for name in _NAMES)
        free = np.full(values.size, np.inf)
        return Parameters(values.copy(), names, -free, free)

    def with_parameters(self, theta: Sequence[float] | Array) -> SecondOrderSections:
        """Give other sections."""
        return SecondOrderSections(as_parameter_vector(theta, self.coefficients.size), self.dt)

    def lipschitz_constant(self) -> float:
        """Give the sum of the absolute impulse response; infinity if not stable."""
        return self.linear().lipschitz_constant()

    def to_dict(self) -> dict[str, Any]:
        """Give kind, sample time and one row for each section."""
        return {"kind": self.kind, "dt": self.dt, "coefficients": self.coefficients.tolist()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> SecondOrderSections:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("dt", "coefficients")))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("sections", tuple(self.coefficients.ravel().tolist())),)


def _has_zeros_inside(b0: float, b1: float, b2: float) -> bool:
    """Tell whether ``b0 z^2 + b1 z + b2`` has both zeros inside the unit circle (Jury's test)."""
    return abs(b2) < abs(b0) and abs(b1) < abs(b0 + b2)

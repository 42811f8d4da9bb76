"""An output that hysteresis and input make together, and that need not rise with the input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NoReturn, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_array
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, operator_from_dict, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Traits

Array = NDArray[np.float64]

MOST_DEGREE = 6

_EXPONENTS = range(-30, 31)
_STROKE = 64


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class Butterfly(Operator):
    """Polynomial of input and hysteresis: ``y = sum_{i+j<=n} c_ij u^i z^j``, z = hysteresis(u).

    With z the polarization of a ferroelectric it is the strain: z^2 electrostriction around the
    polarization, u z the piezoelectric effect that turns with it, u^2 electrostriction proper.

    Parameters
    ----------
    hysteresis
        The operator that makes z of u; z is a pure number. One that reaches about -1 and 1 gives
        coefficients that are output ranges.
    c
        Shape (n + 1, n + 1), ``c[i, j]`` of ``u^i z^j``, output units per input unit to the power
        i; 0 where i + j > n. The degree n is 0 to 6.

    Raises
    ------
    InputError
        If ``hysteresis`` is no operator, ``c`` is not square, of a degree beyond 6 or not finite,
        or a coefficient beyond the degree is not 0.

    Notes
    -----
    y is the same for ``z -> a z + b u + b0`` with other coefficients: scale, offset and linear part
    of z are no constants that a record could show. A hysteresis without a linear part, as plays
    with p0 = 0, and of a given range is a good choice. Mason, Phys. Rev. 74 (1948) 1134;
    Devonshire, Adv. Phys. 3 (1954) 85-130.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> switching = PrandtlIshlinskii(p=[1.5, -1.0], r=[0.25, 0.75])
    >>> strain = Butterfly(switching, [[0.0, 0.0, 1.0], [0.0, 0.25, 0.0], [0.0, 0.0, 0.0]])
    >>> strain([0.0, 1.0, 0.0, -1.0, 0.0, 1.0]).round(4)
    array([0.    , 0.9844, 0.0156, 0.9844, 0.0156, 0.9844])
    """

    hysteresis: Operator
    c: Array

    kind = "butterfly"

    def __init__(self, hysteresis: Operator, c: ArrayLike) -> None:
        if not isinstance(hysteresis, Operator):
            raise InputError(
                f"hysteresis is of type {type(hysteresis).__name__}; give an operator, as "
                "PrandtlIshlinskii"
            )
        object.__setattr__(self, "hysteresis", hysteresis)
        object.__setattr__(self, "c", _as_coefficients(c))

    @property
    def degree(self) -> int:
        """The largest i + j of ``u^i z^j``."""
        return int(self.c.shape[0]) - 1

    @property
    def dt(self) -> float | None:
        """The sample time of the hysteresis, seconds; None if any will do."""
        return self.hysteresis.dt

    def at_sample_time(self, dt: float) -> Operator:
        """Give the same map of the hysteresis for another sample time."""
        return self if self.dt is None else Butterfly(self.hysteresis.at_sample_time(dt), self.c)

    def traits(self) -> Traits:
        """Give the traits: the memory is that of the hysteresis, and nothing else is sure."""
        own = self.hysteresis.traits()
        return Traits(
            memoryless=lambda: own.memoryless,
            rate_independent=own.rate_independent,
            return_point_memory=lambda: own.return_point_memory,
            congruent_loops=False,
            monotone=False,
            invertible=False,
        )

    def initial_state(self) -> Array:
        """Give the state of the hysteresis."""
        return self.hysteresis.initial_state()

    def exact_inverse(self) -> NoReturn:
        """Refuse: one output belongs to several inputs.

        Raises
        ------
        NotInvertibleError
            Always; the input is named at which the output turns.
        """
        turn = self._turn()
        if turn is None:
            raise NotInvertibleError(
                "the output is a polynomial of input and hysteresis, of which nothing says that it "
                "rises with the input everywhere; use compensation method 'trajectory'"
            )
        amplitude, u = turn
        raise NotInvertibleError(
            f"the output is not monotone in the input: driven between {-amplitude:.4g} and "
            f"{amplitude:.4g} it turns where the rising input passes {u:.4g}, so one output "
            "belongs to several inputs; use compensation method 'trajectory', with limits on one "
            "side of the turn"
        )

    def parameters(self) -> Parameters:
        """Give those of the hysteresis, then c row by row as far as i + j goes."""
        own, rows = self.hysteresis.parameters(), terms(self.degree)
        free = np.full(rows[0].size, np.inf)
        return Parameters(
            values=np.concatenate([own.values, self.c[rows]]),
            names=(
                *(f"hysteresis.{name}" for name in own.names),
                *(f"c[{i},{j}]" for i, j in zip(*rows, strict=True)),
            ),
            lower=np.concatenate([own.lower, -free]),
            upper=np.concatenate([own.upper, free]),
        )

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the vector with the nearest one of the hysteresis."""
        count = len(self.hysteresis.parameters())
        own = self.hysteresis.nearest_parameters(theta[:count])
        return np.concatenate([own, theta[count:]])

    def with_parameters(self, theta: Sequence[float] | Array) -> Butterfly:
        """Give the same hysteresis and map with other constants."""
        count, rows = len(self.hysteresis.parameters()), terms(self.degree)
        vector = as_parameter_vector(theta, count + rows[0].size)
        c = np.zeros_like(self.c)
        c[rows] = vector[count:]
        return Butterfly(self.hysteresis.with_parameters(vector[:count]), c)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the parameters; z keeps its numbers."""
        own = self.hysteresis.parameter_scales(input_scale, 1.0)
        powers = float(input_scale) ** -np.arange(self.degree + 1.0)
        return np.concatenate([own, (output_scale * powers)[terms(self.degree)[0]]])

    def in_units(self, input_scale: float, output_scale: float) -> Butterfly:
        """Give the model in other units, with the memory of its hysteresis."""
        powers = float(input_scale) ** -np.arange(self.degree + 1.0)
        c = self.c * (output_scale * powers)[:, None]
        return Butterfly(self.hysteresis.in_units(input_scale, 1.0), c)

    def lipschitz_constant(self) -> float:
        """Give infinity, but for a plane: powers grow without bound."""
        i, j = terms(self.degree)
        if np.any(self.c[i, j][i + j > 1]):
            return float("inf")
        slopes = np.abs(self.c[:2, :2])
        if self.degree == 0:
            return 0.0
        return float(slopes[1, 0] + slopes[0, 1] * self.hysteresis.lipschitz_constant())

    def to_dict(self) -> dict[str, Any]:
        """Give kind, hysteresis and coefficients."""
        return {
            "kind": self.kind,
            "hysteresis": self.hysteresis.to_dict(),
            "c": self.c.tolist(),
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Butterfly:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, required=("hysteresis", "c"))
        return cls(operator_from_dict(given["hysteresis"]), given["c"])

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator, with those of the hysteresis inside."""
        constants = tuple(self.parameters().values.tolist())
        inside, choices = self.hysteresis.stages(), {"degree": self.degree}
        return (Stage("state_map", constants, choices=choices, dt=self.dt, inside=inside),)

    def _turn(self) -> tuple[float, float] | None:
        """Find an amplitude and an input at which the output turns on a stroke between its ends."""
        known = self.description
        amplitudes = [2.0**exponent for exponent in _EXPONENTS]
        if known.input_low is not None and known.input_high is not None:
            amplitudes.insert(0, max(abs(known.input_low), abs(known.input_high)))
        unit = np.linspace(-1.0, 1.0, _STROKE + 1)
        for amplitude in amplitudes:
            up = amplitude * unit
            y = self(np.concatenate([up, up[::-1], up]))[-up.size :]
            span = float(np.ptp(y))
            steps = np.diff(y)
            if span > 0.0 and min(steps.clip(0.0).sum(), -steps.clip(None, 0.0).sum()) > 0.1 * span:
                ends = np.array([max(y[0], y[-1]), min(y[0], y[-1])])
                above, below = y.max() - ends[0], ends[1] - y.min()
                return amplitude, float(up[int(np.argmax(y) if above > below else np.argmin(y))])
        return None


def terms(degree: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Give i and j of the terms ``u^i z^j`` of a polynomial, in the order of the core.

    Parameters
    ----------
    degree
        The largest i + j.
    """
    rows = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    at = np.array(rows, dtype=np.intp)
    return at[:, 0], at[:, 1]


def _as_coefficients(c: ArrayLike) -> Array:
    matrix = finite_array(c, "c")
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
        raise InputError(f"c has shape {matrix.shape}; give c[i, j] of u^i z^j, as many i as j")
    degree = matrix.shape[0] - 1
    if not 0 <= degree <= MOST_DEGREE:
        raise InputError(f"c is of degree {degree}; give 1 to {MOST_DEGREE + 1} rows and columns")
    beyond = np.add.outer(np.arange(degree + 1), np.arange(degree + 1)) > degree
    wrong = np.argwhere(beyond & (matrix != 0.0))
    if wrong.size:
        at = tuple(int(each) for each in wrong[0])
        raise InputError(
            f"c[{at[0]},{at[1]}] is {matrix[at]:.6g}, beyond the degree {degree}; make it 0, or "
            f"give {sum(at) + 1} rows and columns"
        )
    coefficients: Array = np.where(beyond, 0.0, matrix)
    coefficients.flags.writeable = False
    return coefficients

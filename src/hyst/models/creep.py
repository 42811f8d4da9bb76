"""Creep beside a signal, and its exact inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_number, as_sample_time
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.portrait import NOTHING, Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))
LONGEST = 1e15
"""Of a time constant, in samples: beyond, a lag never moves within the digits of a number."""


@dataclass(frozen=True, eq=False, init=False, repr=False)
class _Lags(Operator):
    """What creep and its inverse have in common: all constants."""

    weights: Array
    time_constants: Array
    sample_time: float
    rest: float

    def __init__(
        self, weights: ArrayLike, time_constants: ArrayLike, dt: float, rest: float = 0.0
    ) -> None:
        shares, times = as_constants(weights, "weights"), as_constants(times_of(time_constants), "")
        sample = as_sample_time(dt)
        if shares.size != times.size:
            raise InputError(
                f"there are {shares.size} weights and {times.size} time constants; give one weight "
                "for each time constant"
            )
        require_time_constants(times, sample)
        names = ("weights", "time_constants", "sample_time", "rest")
        for name, value in zip(
            names, (shares, times, sample, as_number(rest, "rest")), strict=True
        ):
            object.__setattr__(self, name, value)

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def __repr__(self) -> str:
        at_rest = f", rest={self.rest!r}" if self.rest else ""
        return (
            f"{type(self).__name__}(weights={self.weights.tolist()}, "
            f"time_constants={self.time_constants.tolist()}, dt={self.dt!r}{at_rest})"
        )

    def at_sample_time(self, dt: float) -> Self:
        """Give the same creep for records of another sample time: its constants are in seconds."""
        return type(self)(self.weights, self.time_constants, dt, self.rest)

    def gains(self) -> Array:
        """Give by which share of its way each lag moves in one sample, ``1 - exp(-dt / tau)``."""
        return np.asarray(-np.expm1(-self.dt / self.time_constants))

    def initial_state(self) -> Array:
        """Give lags at rest with nothing carried over, shape (2 n,)."""
        return np.tile([self.rest, 0.0], self.weights.size)

    def parameters(self) -> Parameters:
        """Give the weights, then the time constants, s."""
        n = self.weights.size
        return Parameters(
            values=np.concatenate([self.weights, self.time_constants]),
            names=(*numbered("weights", n), *numbered("time_constants", n)),
            lower=np.repeat([-np.inf, 1e-6 * self.dt], n),
            upper=np.repeat([np.inf, LONGEST * self.dt], n),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give other weights and time constants; sample time and rest stay."""
        n = self.weights.size
        vector = as_parameter_vector(theta, 2 * n)
        return type(self)(vector[:n], vector[n:], self.dt, self.rest)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give ones: weights are shares of the signal, and time keeps its unit.

        Raises
        ------
        InputError
            If input and output grow by different factors.
        """
        if input_scale != output_scale:
            raise InputError(
                "creep leaves the unit of its signal as it is; put the gain into an Affine or the "
                "model beside it"
            )
        return np.ones(2 * self.weights.size)

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the same creep in other units, the level at rest too."""
        self.parameter_scales(input_scale, output_scale)
        return type(self)(self.weights, self.time_constants, self.dt, self.rest * input_scale)

    def keeps_unit(self) -> bool:
        """Tell that creep has the unit of what creeps."""
        return True

    def portrait(self) -> Portrait:
        """Show nothing: creep is seen over time, not over the input."""
        return NOTHING

    def to_dict(self) -> dict[str, Any]:
        """Give kind, sample time, weights, time constants and, where there is one, the rest."""
        more = {"rest": self.rest} if self.rest else {}
        return {
            "kind": self.kind,
            "dt": self.dt,
            "weights": self.weights.tolist(),
            "time_constants": self.time_constants.tolist(),
            **more,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("dt", "weights", "time_constants"), ("rest",)))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is what has crept."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        constants = (*self.weights.tolist(), *self.time_constants.tolist())
        choices = {"inverse": int(self._is_inverse())}
        return (Stage("creep", constants, choices=choices, dt=self.dt),)


def times_of(values: ArrayLike) -> Array:
    """Give time constants as an array, with the name they have in messages."""
    return as_constants(values, "time_constants")


def require_time_constants(times: Array, dt: float) -> None:
    """Refuse time constants that are no times, or so long that no lag moves.

    Parameters
    ----------
    times
        Time constants, s.
    dt
        Sample time, s.

    Raises
    ------
    InputError
        If one is not of 1e-6 to 1e15 samples.
    """
    for i, tau in enumerate(times):
        if not tau > 0.0:
            raise InputError(f"time_constants[{i}] is {tau}; give a time above 0, in seconds")
        if not 1e-6 * dt <= tau <= LONGEST * dt:
            raise InputError(
                f"time_constants[{i}] is {tau:.6g} s, {tau / dt:.3g} samples of {dt:.6g} s; give "
                f"one of 1e-6 to {LONGEST:g} samples"
            )


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class Creep(_Lags):
    """Creep: ``y = u + sum_i weights_i x_i``, x_i first-order lags that answer one sample later.

    ``x_{i,k+1} = x_{i,k} + (1 - exp(-dt / tau_i)) (u_k - x_{i,k})``: after a step of u the output
    goes on by ``sum_i weights_i (1 - exp(-t / tau_i))`` of the step.

    Parameters
    ----------
    weights
        Shape (n,), shares of the signal by which it creeps in the end; negative ones creep back.
    time_constants
        Shape (n,), tau, s, > 0. Logarithmic creep of c per decade of time comes to within 2 % of c
        with ``weights = c`` and time constants that grow tenfold.
    dt
        Sample time, s.
    rest
        The level u has had for long before the first sample, units of u.

    Raises
    ------
    InputError
        If there are not as many weights as time constants, a time constant is not positive, or
        a number is not finite.

    Notes
    -----
    H. Jung and D.-G. Gweon, Creep characteristics of piezoelectric actuators, Rev. Sci. Instrum. 71
    (2000) 1896-1900, for the logarithmic law; P. Krejci and K. Kuhnen, Inverse control of systems
    with hysteresis and creep, IEE Proc. Control Theory Appl. 148 (2001) 185-192, for lags, and for
    lags that plays drive: ``Creep(..) @ PrandtlIshlinskii(..)`` here.

    Examples
    --------
    >>> creep = Creep([0.5], [1.0], dt=1.0)
    >>> creep([1.0, 1.0, 1.0]).round(6)
    array([1.      , 1.31606 , 1.432332])
    >>> creep.inverse()(creep([1.0, 3.0, 2.0]))
    array([1., 3., 2.])
    """

    kind = "creep"

    def traits(self) -> Traits:
        """Give the traits of a linear memory that forgets."""
        return Traits(
            memoryless=not self.weights.size,
            rate_independent=Degree.NO if self.weights.size else Degree.EXACTLY,
            return_point_memory=not self.weights.size,
            congruent_loops=not self.weights.size,
            monotone=not self.weights.size,  # a lag falls on while the input begins to rise
            invertible=self.is_invertible,
        )

    def lipschitz_constant(self) -> float:
        """Give ``1 + sum_i |weights_i|``, which is the least where no weight is negative."""
        return 1.0 + float(np.abs(self.weights).sum())

    def exact_inverse(self) -> InverseCreep:
        """Give the exact inverse: the lags are known before the sample, which passes as it is.

        Raises
        ------
        NotInvertibleError
            If the creep is so strong, or goes so far back, that a command which cancels it grows
            without bound.
        """
        why = _growth(self.weights, self.gains())
        if why:
            raise NotInvertibleError(why)
        return InverseCreep(self.weights, self.time_constants, self.dt, self.rest)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class InverseCreep(_Lags):
    """Inverse of creep, from what has crept to what was given; ``Creep.inverse()`` makes it.

    Parameters
    ----------
    weights, time_constants, dt, rest
        As in ``Creep``, whose input the lags follow.

    Raises
    ------
    InputError
        As ``Creep``.

    Examples
    --------
    >>> Creep([0.5], [1.0], dt=1.0).inverse()([1.0, 1.0]).round(6)
    array([1.     , 0.68394])
    """

    kind = "inverse-creep"

    def traits(self) -> Traits:
        """Give the traits of a linear memory that forgets."""
        return Traits(
            memoryless=not self.weights.size,
            rate_independent=Degree.NO if self.weights.size else Degree.EXACTLY,
            return_point_memory=not self.weights.size,
            congruent_loops=not self.weights.size,
            monotone=not self.weights.size,
            invertible=True,
        )

    def lipschitz_constant(self) -> float:
        """Give a bound of the absolute impulse response's sum; infinity if it grows.

        It is the sum itself where no weight is negative and no lag is faster than a sample.
        """
        if _growth(self.weights, self.gains()):
            return float("inf")
        return _inverse_gain(self.weights, self.gains())

    def exact_inverse(self) -> Creep:
        """Give the creep."""
        return Creep(self.weights, self.time_constants, self.dt, self.rest)

    def _is_inverse(self) -> bool:
        return True


def _growth(weights: Array, gains: Array) -> str:
    """Say why a command that cancels the creep would grow, or nothing.

    The lags of the inverse follow ``x' = (1 - M) x`` with ``M = diag(g) + g w^T``; what counts is
    how eigenvalues m of M lie to the circle ``|1 - m| < 1``, which is told without taking them
    from 1, since those of slow lags are tiny.
    """
    if not weights.size:
        return ""
    total = 1.0 + float(weights.sum())
    if total <= 0.0:
        return (
            f"the weights sum up to {weights.sum():.6g}: what is given creeps back all the way, or "
            "further, so no command holds the output; the sum must be above -1"
        )
    modes = np.linalg.eigvals(gains[:, None] * (np.eye(weights.size) + weights[None, :]))
    outside = np.abs(modes) ** 2 >= 2.0 * modes.real
    if not outside.any():
        return ""
    worst = float(np.abs(1.0 - modes).max())
    return (
        f"a command that cancels this creep would grow by a factor of {worst:.6g} from sample to "
        "sample: creep of these weights that comes within a sample is too strong; leave lags "
        "shorter than some samples to the dynamics"
    )


def _inverse_gain(weights: Array, gains: Array) -> float:
    """Bound the sum of the absolute impulse response of a stable inverse, mode by mode."""
    if not weights.size:
        return 1.0
    modes, vectors = np.linalg.eig(gains[:, None] * (np.eye(weights.size) + weights[None, :]))
    try:
        shares = (weights @ vectors) * np.linalg.solve(vectors, gains.astype(vectors.dtype))
    except np.linalg.LinAlgError:
        return float("inf")
    # 1 - |1 - m|, without the digits of m that a difference from 1 would lose.
    lost = (2.0 * modes.real - np.abs(modes) ** 2) / (1.0 + np.abs(1.0 - modes))
    return 1.0 + float((np.abs(shares) / lost).sum()) * (1.0 + 1e-9)

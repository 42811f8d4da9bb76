"""Plays whose outputs creep, each with weights of its own, and the exact inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, as_reals
from hyst.checks.numbers import as_sample_time
from hyst.errors import InputError, NotInvertibleError
from hyst.models.creep import LONGEST, require_time_constants, times_of
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, init=False, repr=False)
class _CreepingBank(Operator):
    """What creeping plays and their inverse have in common: all constants."""

    plays: PrandtlIshlinskii
    weights: Array
    time_constants: Array
    sample_time: float

    def __init__(
        self,
        p: ArrayLike,
        r: ArrayLike,
        p0: float,
        weights: ArrayLike,
        time_constants: ArrayLike,
        dt: float,
    ) -> None:
        plays, step = PrandtlIshlinskii(p, r, p0), as_sample_time(dt)
        times = times_of(time_constants)
        given, shape = as_reals(weights, "weights"), (plays.p.size, times.size)
        # A file holds the rows: none of no plays, whatever the number of time constants.
        if given.shape != shape and not (shape[0] == 0 and given.shape == (0,)):
            raise InputError(
                f"weights has shape {given.shape}; give a row for each of {shape[0]} plays, with a "
                f"weight for each of {shape[1]} time constants"
            )
        shares = as_constants(given.ravel(), "weights")
        require_time_constants(times, step)
        object.__setattr__(self, "plays", plays)
        object.__setattr__(self, "weights", shares.reshape(shape))
        object.__setattr__(self, "time_constants", times)
        object.__setattr__(self, "sample_time", step)

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def _constants(self) -> dict[str, Any]:
        bank = self.plays
        return {
            "p": bank.p.tolist(),
            "r": bank.r.tolist(),
            "p0": bank.p0,
            "weights": [row.tolist() for row in self.weights],
            "time_constants": self.time_constants.tolist(),
        }

    def __repr__(self) -> str:
        words = ", ".join(f"{name}={value!r}" for name, value in self._constants().items())
        return f"{type(self).__name__}({words}, dt={self.dt!r})"

    def at_sample_time(self, dt: float) -> Self:
        """Give the same operator for records of another sample time: it is in seconds."""
        return type(self)(**self._constants(), dt=dt)

    def initial_state(self) -> Array:
        """Give plays and lags at rest with nothing carried over."""
        banks = 2 if self._is_inverse() else 1
        return np.zeros(self.plays.p.size * banks + 2 * self.weights.size)

    def parameters(self) -> Parameters:
        """Give p0, p and r, the weights play after play, then the time constants, s."""
        bank, (n, m) = self.plays.parameters(), self.weights.shape
        pairs = [f"weights[{i},{j}]" for i in range(1, n + 1) for j in range(1, m + 1)]
        free, limits = np.full(n * m, np.inf), np.array([1e-6, LONGEST]) * self.dt
        return Parameters(
            values=np.concatenate([bank.values, self.weights.ravel(), self.time_constants]),
            names=(*bank.names, *pairs, *numbered("time_constants", m)),
            lower=np.concatenate([bank.lower, -free, np.full(m, limits[0])]),
            upper=np.concatenate([bank.upper, free, np.full(m, limits[1])]),
        )

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the nearest vector whose thresholds ascend."""
        count = 1 + 2 * self.plays.p.size
        return np.concatenate([self.plays.nearest_parameters(theta[:count]), theta[count:]])

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give other constants; sizes and sample time stay."""
        n, m = self.weights.shape
        vector = as_parameter_vector(theta, 1 + n * (2 + m) + m)
        p, r, weights, times = np.split(vector[1:], [n, 2 * n, 2 * n + n * m])
        return type(self)(p, r, float(vector[0]), weights.reshape(n, m), times, self.dt)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of p0, p, r and the weights; time keeps its unit.

        Those of the inverse, whose constants are those of what it undoes, are of that.
        """
        into, out = (
            (output_scale, input_scale) if self._is_inverse() else (input_scale, output_scale)
        )
        return np.concatenate(
            [
                self.plays.parameter_scales(into, out),
                np.full(self.weights.size, out / into),
                np.ones(self.time_constants.size),
            ]
        )

    def to_dict(self) -> dict[str, Any]:
        """Give kind and constants."""
        return {"kind": self.kind, **self._constants(), "dt": self.dt}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("p", "r", "p0", "weights", "time_constants", "dt")))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is what has crept."""

    def _loop_gain(self) -> float:
        """Bound what comes back of a command by way of the lags; infinity without an inverse."""
        if not (self.plays.p0 > 0.0 and self.plays.is_invertible()):
            return float("inf")
        return float(np.abs(self.weights).sum()) * self.plays.inverse().lipschitz_constant()

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        n, m = self.weights.shape
        choices = {"plays": n, "lags": m, "inverse": int(self._is_inverse())}
        constants = tuple(self.parameters().values.tolist())
        return (Stage("creeping_plays", constants, choices=choices, dt=self.dt),)


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class CreepingPlays(_CreepingBank):
    """Plays that creep: ``y = p0 u + sum_i p_i z_i + sum_ij w_ij x_ij``, x_ij lags of the play z_i.

    ``x_{ij,k+1} = x_{ij,k} + (1 - exp(-dt / tau_j)) (z_{i,k} - x_{ij,k})``, all at rest at 0 before
    the first sample. With ``w_ij = p_i v_j``, and the same for p0 u, it is ``Creep(v, tau) @
    PrandtlIshlinskii(p, r, p0)``.

    Parameters
    ----------
    p, r, p0
        As in ``PrandtlIshlinskii``.
    weights
        w, shape (n, m): for each play by how much it creeps in each lag, output units per input
        unit.
    time_constants
        tau, shape (m,), s, > 0.
    dt
        Sample time, s.

    Raises
    ------
    InputError
        If shapes do not fit, thresholds do not ascend, or a time constant is not positive.

    Notes
    -----
    P. Krejci and K. Kuhnen, Inverse control of systems with hysteresis and creep, IEE Proc. Control
    Theory Appl. 148 (2001) 185-192, for creep that plays drive.

    Examples
    --------
    >>> weights, times = [[0.02, 0.01], [0.0, 0.05]], [1.0, 10.0]
    >>> stage = CreepingPlays([0.5, 0.3], [0.1, 0.4], 1.0, weights, times, dt=0.1)
    >>> u = np.sin(np.arange(50.0))
    >>> bool(np.abs(stage.inverse()(stage(u)) - u).max() < 1e-14)
    True
    """

    kind = "creeping-plays"

    def traits(self) -> Traits:
        """Give the traits of plays with a memory that forgets."""
        rests = not self.weights.any()
        plays = self.plays.traits()
        return Traits(
            memoryless=False,
            rate_independent=Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=rests and plays.monotone,
            invertible=self.is_invertible,
        )

    def lipschitz_constant(self) -> float:
        """Give that of the plays and ``sum |w|``."""
        return self.plays.lipschitz_constant() + float(np.abs(self.weights).sum())

    def exact_inverse(self) -> InverseCreepingPlays:
        """Give the exact inverse: that of the plays, of what the lags leave of the output.

        Raises
        ------
        NotInvertibleError
            If the plays have none or no p0 > 0; or the weights are so large that a command might
            grow by way of the lags: ``sum |w|`` times the Lipschitz constant of the plays' inverse
            must be below 1, which is enough, if not needed.
        """
        if not self.plays.p0 > 0.0:
            raise NotInvertibleError(
                f"p0 is {self.plays.p0:.6g}: without a positive linear part the plays leave the "
                "input open"
            )
        steepest = self.plays.exact_inverse().lipschitz_constant()
        gain = self._loop_gain()
        if not gain < 1.0:
            raise NotInvertibleError(
                f"the weights of the creep sum up to {np.abs(self.weights).sum():.6g} in size, and "
                f"the inverse of the plays has a Lipschitz constant of {steepest:.6g}: their "
                f"product, {gain:.6g}, must be below 1 for a command that is shown not to grow"
            )
        return InverseCreepingPlays(**self._constants(), dt=self.dt)

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class InverseCreepingPlays(_CreepingBank):
    """Inverse of plays that creep; ``CreepingPlays.inverse()`` makes it.

    Parameters
    ----------
    p, r, p0, weights, time_constants, dt
        As in ``CreepingPlays``, which must have an inverse.

    Raises
    ------
    InputError
        As ``CreepingPlays``, or if that has no inverse.

    Examples
    --------
    >>> CreepingPlays([0.5], [1.0], 1.0, [[0.1]], [1.0], 1.0).inverse()([3.0, 3.0]).round(6)
    array([2.333333, 2.249051])
    """

    kind = "inverse-creeping-plays"

    def __init__(
        self,
        p: ArrayLike,
        r: ArrayLike,
        p0: float,
        weights: ArrayLike,
        time_constants: ArrayLike,
        dt: float,
    ) -> None:
        super().__init__(p, r, p0, weights, time_constants, dt)
        if not self._loop_gain() < 1.0:
            raise InputError(
                "these plays and their creep have no inverse that is shown not to grow; "
                "CreepingPlays(..).inverse() says why"
            )

    def traits(self) -> Traits:
        """Give the traits of plays with a memory that forgets."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=False,
            invertible=True,
        )

    def lipschitz_constant(self) -> float:
        """Give ``L / (1 - L sum |w|)``, L that of the plays' inverse."""
        steepest = self.plays.inverse().lipschitz_constant()
        return steepest / (1.0 - self._loop_gain()) * (1.0 + 1e-9)

    def exact_inverse(self) -> CreepingPlays:
        """Give the plays that creep."""
        return CreepingPlays(**self._constants(), dt=self.dt)

    def _is_inverse(self) -> bool:
        return True

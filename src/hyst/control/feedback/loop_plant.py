"""The plant as a loop meets it: with its dead time, sampled behind a hold where a block runs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative
from hyst.control.linear_system import LinearSystem, balanced_matrices
from hyst.control.loop_system import plant_of
from hyst.control.sampled.plant import SampledPlant, sampled_plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class LoopPlant:
    """A plant and its dead time: ``P(jw) exp(-jw delay)``, or as a sampled block sees it.

    Parameters
    ----------
    system
        Continuous, without dead time; or sampled, with it.
    delay
        Dead time in continuous time, s; 0 if sampled.
    sampled
        The sampled plant; None in continuous time.
    """

    system: LinearSystem
    delay: float
    sampled: SampledPlant | None

    @property
    def dt(self) -> float:
        """Sample time, s; 0 in continuous time."""
        return self.system.dt

    @property
    def continuous(self) -> LinearSystem | None:
        """The continuous plant, without dead time; None if it is not known."""
        return self.system if self.sampled is None else self.sampled.continuous

    @property
    def dead_time(self) -> float:
        """Dead time that was put before the plant, s."""
        return self.delay if self.sampled is None else self.sampled.delay

    @property
    def nyquist(self) -> float:
        """Highest frequency there is, rad/s."""
        return math.pi / self.dt if self.dt else math.inf

    def response(self, w: Array) -> ComplexArray:
        """Values at frequencies, rad/s, (n,)."""
        s = points(w, self.dt)
        whole = self._whole_samples()
        if whole:
            return np.asarray(self._undelayed.response(s)[:, 0, 0] * s ** -float(whole))
        found = self.system.response(s)[:, 0, 0]
        return np.asarray(found * np.exp(-s * self.delay) if self.delay else found)

    def _whole_samples(self) -> int:
        """Count the whole samples of dead time, each of them a state of the system."""
        if self.sampled is None or self.sampled.continuous is None:
            return 0
        return int(self.sampled.delay / self.dt + 1e-9)

    @cached_property
    def _undelayed(self) -> LinearSystem:
        """The sampled plant without them: a response of hundreds of states takes minutes."""
        late = self.dead_time - self._whole_samples() * self.dt
        rest = late if late > 1e-9 * self.dead_time else 0.0
        return sampled_plant(self.continuous, self.dt, rest).system

    def static_gain(self) -> float:
        """Give the output per constant input; infinite with a pole at the origin."""
        return static_gain(self.system)


def points(w: Array, dt: float) -> ComplexArray:
    """Give s = jw, or z = exp(jw dt).

    Parameters
    ----------
    w
        Frequencies, rad/s.
    dt
        Sample time, s; 0 in continuous time.
    """
    return np.asarray(np.exp(1j * w * dt) if dt else 1j * w, dtype=np.complex128)


def as_rates(system: LinearSystem) -> ComplexArray:
    """Give the poles of a system in 1/s; those of a sampled one by their logarithm."""
    return rates_of(system.poles(), system.dt)


def rates_of(poles: ComplexArray, dt: float) -> ComplexArray:
    """Give poles in 1/s; those of whole samples of dead time, at z = 0, are left out.

    Parameters
    ----------
    poles
        In s or z.
    dt
        Sample time, s; 0 in continuous time.
    """
    if not dt:
        return poles
    # Rounding spreads m poles at 0 over a circle of radius eps^(1/m).
    return np.asarray(np.log(poles[np.abs(poles) > 1e-3]) / dt, dtype=np.complex128)


def static_gain(system: LinearSystem) -> float:
    """Give the output per constant input of a system with one input and one output.

    Parameters
    ----------
    system
        Continuous or sampled.

    Returns
    -------
    float
        Infinite with an integrator; 0 with a zero at the origin.

    Examples
    --------
    >>> from hyst.control import as_linear_system
    >>> static_gain(as_linear_system(([6.0], [1.0, 2.0])))
    3.0
    """
    if system.order == 0:
        return float(system.D[0, 0])
    origin = 1.0 if system.dt else 0.0
    poles = system.poles()
    if np.abs(poles - origin).min() <= 1e-9 * max(1.0, float(np.abs(poles).max())):
        return math.inf
    A, B, C = balanced_matrices(system.A, system.B, system.C)
    x = np.linalg.solve(origin * np.eye(system.order) - A, B)
    gain = float((C @ x + system.D)[0, 0])
    # With a zero at the origin, what is left of its parts is rounding.
    size = float((np.abs(C) @ np.abs(x) + np.abs(system.D))[0, 0])
    return gain if abs(gain) > _ROUNDING * size else 0.0


def loop_plant(plant: Any, dt: float | None = None, delay: float = 0.0) -> LoopPlant:
    """Read a plant and put the dead time and the hold of a loop before it.

    Parameters
    ----------
    plant
        As ``sampled_plant`` takes it.
    dt
        Sample time of the block, s; None for that of a sampled plant, or a continuous loop.
    delay
        Dead time from the measurement to its drive, s: the computing time of the block.

    Returns
    -------
    LoopPlant

    Raises
    ------
    InputError
        As ``sampled_plant``.
    """
    late = as_not_negative(delay, "delay", "a time in s")
    if dt is None and not isinstance(plant, SampledPlant):
        read = plant_of(plant)
        if not read.dt:
            return LoopPlant(read, late, None)
    found = sampled_plant(plant, dt, late)
    return LoopPlant(found.system, 0.0, found)

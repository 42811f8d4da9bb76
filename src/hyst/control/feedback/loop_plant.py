"""The plant as a loop meets it: with its dead time, and sampled behind a hold where a block runs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_sample_time
from hyst.control.linear_system import LinearSystem
from hyst.control.loop_system import plant_of
from hyst.errors import InputError
from hyst.models import LinearDynamics

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_WHOLE = 1e-9  # samples: what is left of a whole number after a division by dt
_MOST_SAMPLES = 400  # of delay; each is a state of the loop


@dataclass(frozen=True, eq=False)
class LoopPlant:
    """A plant and its dead time.

    ``P(jw) exp(-jw delay)``, or ``core(z) z^-late`` if sampled.

    Parameters
    ----------
    core
        Continuous, or sampled with every part of a sample of dead time in it.
    late
        Whole samples of dead time; 0 in continuous time.
    delay
        Dead time in continuous time, s; 0 if sampled.
    continuous
        The continuous plant, without dead time; None if it is not known.
    dead_time
        All of the dead time that is not in ``continuous``, s.
    """

    core: LinearSystem
    late: int
    delay: float
    continuous: LinearSystem | None
    dead_time: float

    @property
    def dt(self) -> float:
        """Sample time, s; 0 in continuous time."""
        return self.core.dt

    @property
    def nyquist(self) -> float:
        """Highest frequency there is, rad/s."""
        return math.pi / self.dt if self.dt else math.inf

    def response(self, w: Array) -> ComplexArray:
        """Values at frequencies, rad/s, (n,)."""
        s = points(w, self.dt)
        held = self.core.response(s)[:, 0, 0]
        return np.asarray(held * (s**-self.late if self.dt else np.exp(-s * self.delay)))

    def static_gain(self) -> float:
        """Give the output per constant input; infinite with a pole at the origin."""
        return static_gain(self.core)

    def system(self) -> LinearSystem:
        """Give all of it as one system; in continuous time there must be no dead time."""
        if self.delay:
            raise InputError("a continuous system with dead time has no matrices; give dt")
        return _lined_up(self.core, self.late) if self.late else self.core

    def features(self) -> ComplexArray:
        """Give poles as logarithms, 1/s, whatever the time is."""
        return as_rates(self.core)


def points(w: Array, dt: float) -> ComplexArray:
    """Give s = jw, or z = exp(jw dt)."""
    return np.asarray(np.exp(1j * w * dt) if dt else 1j * w, dtype=np.complex128)


def as_rates(system: LinearSystem) -> ComplexArray:
    """Give the poles of a system in 1/s; those of a sampled one by their logarithm."""
    poles = system.poles()
    if not system.dt:
        return poles
    kept = poles[np.abs(poles) > 1e-12]
    return np.asarray(np.log(kept) / system.dt, dtype=np.complex128)


def static_gain(system: LinearSystem) -> float:
    """Give the output of a system with one input per constant input; infinite with an integrator."""
    if system.order == 0:
        return float(system.D[0, 0])
    origin = 1.0 if system.dt else 0.0
    poles = system.poles()
    if np.abs(poles - origin).min() <= 1e-9 * max(1.0, float(np.abs(poles).max())):
        return math.inf
    return float(system.response(np.array([origin + 0j]))[0, 0, 0].real)


def loop_plant(plant: Any, dt: float | None = None, delay: float = 0.0) -> LoopPlant:
    """Read a plant and put the dead time and the hold of a loop before it.

    Parameters
    ----------
    plant
        As ``simulate_closed_loop`` takes it; a LinearDynamics brings its delay and its dt.
    dt
        Sample time of the block, s; None for a loop in continuous time.
    delay
        Dead time from the measurement to its drive, s: the computing time of the block.

    Returns
    -------
    LoopPlant

    Raises
    ------
    InputError
        If the plant cannot be read or is unstable, sample times differ, or a sampled plant is given
        a dead time that is no whole number of samples.
    """
    late = as_not_negative(delay, "delay", "a dead time in seconds, 0 or more")
    own = plant.delay if isinstance(plant, LinearDynamics) else 0
    read = plant_of(_without_delay(plant))
    time = _sample_time(read, dt)
    if not time:
        return LoopPlant(read, 0, late, read, late)
    if late / time + own > _MOST_SAMPLES:
        raise InputError(
            f"delay is {late / time + own:.6g} samples; at most {_MOST_SAMPLES} can be counted"
        )
    if read.dt:
        extra = round(late / time)
        if abs(late / time - extra) > 1e-6:
            raise InputError(
                f"delay is {late / time:.6g} samples, and the plant is sampled; give whole samples "
                "of delay, or the continuous plant"
            )
        core, whole = _strictly_proper(read, own + extra)
        return LoopPlant(core, whole, 0.0, None, (own + extra) * time)
    core, whole = _held_late(read, time, late / time)
    return LoopPlant(*_strictly_proper(core, whole), 0.0, read, late)


def _without_delay(plant: Any) -> Any:
    if isinstance(plant, LinearDynamics) and plant.delay:
        return LinearDynamics(plant.A, plant.B, plant.C, plant.D, plant.dt)
    return plant


def _sample_time(read: LinearSystem, dt: float | None) -> float:
    if dt is None:
        return read.dt
    time = as_sample_time(dt)
    if read.dt and abs(read.dt - time) > 1e-6 * time:
        raise InputError(
            f"the plant has dt = {read.dt:.6g} s, the loop {time:.6g} s; give the same for both"
        )
    return time


def _held_late(plant: LinearSystem, dt: float, late: float) -> tuple[LinearSystem, int]:
    """Sample behind a hold that changes ``late`` samples after each instant; exact.

    With the whole number d above it and g = d - late the hold changes g before an instant:
    ``A = exp(L), B = int_0^1 exp(L (s + g)) ds b`` less what acts past the end, ``D = c J(g) b``.
    """
    whole = round(late) if abs(late - round(late)) <= _WHOLE else math.ceil(late)
    ahead = max(whole - late, 0.0)
    if plant.order == 0:
        return LinearSystem(plant.A, plant.B, plant.C, plant.D, dt), whole
    balanced, (scale, _) = scipy.linalg.matrix_balance(plant.A, permute=False, separate=True)
    L, b, c = balanced * dt, plant.B / scale[:, None] * dt, plant.C * scale
    through, new = _held(L, b, ahead)
    stay, old = _held(L, b, 1.0 - ahead)
    # The old value acts first, and what it did is carried on while the new one acts.
    A, B = through @ stay, through @ old + (through @ stay) @ new
    return LinearSystem(A, B, c, plant.D + c @ new, dt), whole


def _held(L: Array, b: Array, time: float) -> tuple[Array, Array]:
    """Give ``exp(L t)`` and ``int_0^t exp(L s) ds b``."""
    n = b.shape[0]
    block = np.zeros((n + 1, n + 1))
    block[:n, :n], block[:n, n:] = L * time, b * time
    sampled = scipy.linalg.expm(block)
    return sampled[:n, :n], sampled[:n, n:]


def _strictly_proper(core: LinearSystem, late: int) -> tuple[LinearSystem, int]:
    """Give y as it is before the new drive acts: what feeds through comes one sample later."""
    if late or not core.D.any():
        return core, late
    n = core.order
    A, C = np.zeros((n + 1, n + 1)), np.zeros((1, n + 1))
    A[:n, :n], C[:, :n], C[0, n] = core.A, core.C, core.D[0, 0]
    B = np.vstack([core.B, np.ones((1, 1))])
    return LinearSystem(A, B, C, np.zeros((1, 1)), core.dt), 0


def _lined_up(core: LinearSystem, late: int) -> LinearSystem:
    n = core.order
    A, B, C = np.zeros((n + late, n + late)), np.zeros((n + late, 1)), np.zeros((1, n + late))
    A[:n, :n], A[:n, n], C[:, :n], C[0, n] = core.A, core.B[:, 0], core.C, core.D[0, 0]
    A[np.arange(n, n + late - 1), np.arange(n + 1, n + late)] = 1.0
    B[-1] = 1.0
    return LinearSystem(A, B, C, np.zeros((1, 1)), core.dt)

"""The plant as a sampled block sees it: hold, delay of computation and sampling."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_sample_time
from hyst.control.discretization import held
from hyst.control.linear_system import LinearSystem
from hyst.control.loop_system import plant_of
from hyst.errors import InputError

Array = NDArray[np.float64]

# Of delay, a state each: with more a certificate takes minutes, and its poles lose their digits.
LARGEST_DELAY = 100


@dataclass(frozen=True)
class SampledPlant:
    """A plant between the drive that a block holds and the output that it samples.

    Parameters
    ----------
    system
        Sampled at dt, strictly proper, the delay among its states.
    continuous
        P(s) without the delay, one input and one output; None where only samples of it are known.
    delay
        s, from the instant at which y is read to that at which the drive that follows from it acts.
    """

    system: LinearSystem
    continuous: LinearSystem | None
    delay: float

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self.system.dt


def sampled_plant(plant: Any, dt: float | None = None, delay: float = 0.0) -> SampledPlant:
    r"""Sample a plant as the block that drives it does, exactly.

    ``x_{k+1} = e^{A dt} x_k + B_0 w_{k-m} + B_1 w_{k-m-1}`` with ``delay = (m + e) dt``, ``B_0``
    and ``B_1`` the integrals of ``e^{A t} B`` over the last ``(1 - e) dt`` and the first ``e dt``
    of a sample. At sample k the block is given y as it is before its new drive acts.

    Parameters
    ----------
    plant
        From the output of the hysteresis to y: as ``simulate_closed_loop`` takes it, or a
        SampledPlant, which is given back.
    dt
        Sample time, s, > 0; that of a sampled plant if left out.
    delay
        s, >= 0, of computation and conversion, at most 100 samples; whole samples for a plant that
        is itself sampled.

    Returns
    -------
    SampledPlant

    Raises
    ------
    InputError
        If the plant cannot be read or is unstable, dt is missing or is not that of a sampled plant,
        or the delay is negative, too long, or between the samples of a sampled plant.

    Examples
    --------
    >>> lag = sampled_plant(([100.0], [1.0, 100.0]), dt=0.01, delay=0.004)
    >>> lag.system.order, bool(abs(lag.system.poles().real.max() - np.exp(-1.0)) < 1e-15)
    (2, True)
    """
    if isinstance(plant, SampledPlant):
        return _with(plant, dt, delay)
    read = plant_of(plant)
    if dt is None and read.dt == 0.0:
        raise InputError("the plant is continuous; give dt, the sample time of the block, in s")
    time = as_sample_time(read.dt if dt is None else dt)
    late = as_not_negative(delay, "delay", "a time in s")
    whole, rest = _split(late, time)
    if read.dt == 0.0:
        return SampledPlant(_late(read, time, whole, rest), read, late)
    if abs(read.dt - time) > 1e-6 * time:
        raise InputError(
            f"the plant has dt = {read.dt:.6g} s, the loop {time:.6g} s; give the same for both, "
            "or the plant in continuous time"
        )
    if rest > 0.0:
        raise InputError(
            f"the delay of {late:.6g} s is {late / time:.6g} samples of a plant that is known at "
            "its samples only; give whole samples, or the plant in continuous time"
        )
    return SampledPlant(_after(read, whole), None, late)


def _with(plant: SampledPlant, dt: float | None, delay: float) -> SampledPlant:
    if dt is not None and abs(plant.dt - dt) > 1e-6 * plant.dt:
        raise InputError(
            f"the plant is sampled at {plant.dt:.6g} s, the block runs at {dt:.6g} s; "
            "sample it anew"
        )
    if delay not in (0.0, plant.delay):
        raise InputError(
            f"the plant has a delay of {plant.delay:.6g} s already; sample it anew with the other"
        )
    return plant


def _split(delay: float, dt: float) -> tuple[int, float]:
    """Whole samples of a delay, and the rest in seconds."""
    samples = delay / dt
    if samples > LARGEST_DELAY:
        raise InputError(
            f"the delay of {delay:.6g} s is {samples:.4g} samples; at most {LARGEST_DELAY} can be "
            "taken in; give a longer dt"
        )
    nearest = round(samples)
    if abs(samples - nearest) < 1e-9 * max(1.0, samples):
        return nearest, 0.0
    whole = math.floor(samples)
    return whole, delay - whole * dt


def _late(plant: LinearSystem, dt: float, whole: int, rest: float) -> LinearSystem:
    """Sample a continuous plant whose held input comes late."""
    if rest == 0.0:
        A, B, C, D = held(plant, dt)
        return _after(LinearSystem(A, B, C, D, dt), whole)
    early = held(plant, rest)
    late = held(plant, dt - rest)
    # The drive of before acts for the first part of a sample; the rest of it carries this on.
    old, new = late[0] @ early[1], late[1]
    n = plant.order
    A = np.zeros((n + 1, n + 1))
    A[:n, :n], A[:n, n:] = late[0] @ early[0], old
    B = np.vstack([new, [[1.0]]])
    C = np.hstack([plant.C, plant.D])
    return _after(LinearSystem(A, B, C, np.zeros((1, 1)), dt), whole)


def _after(plant: LinearSystem, whole: int) -> LinearSystem:
    """Put whole samples of delay before a sampled plant, and one state more for a feedthrough."""
    # y is read before the drive of the same sample acts: feedthrough is of the one before.
    direct = float(plant.D[0, 0])
    if whole == 0 and direct == 0.0:
        return plant
    n, m = plant.order, whole + (direct != 0.0)
    # States: those of the plant, then the drives of the last m samples, the latest first.
    A, B = np.zeros((n + m, n + m)), np.zeros((n + m, 1))
    A[:n, :n] = plant.A
    C = np.hstack([plant.C, np.zeros((1, m))])
    if whole == 0:
        B[:n] = plant.B
    else:
        A[:n, n + whole - 1] = plant.B[:, 0]
    B[n, 0] = 1.0
    A[np.arange(n + 1, n + m), np.arange(n, n + m - 1)] = 1.0
    if direct != 0.0:
        C[0, n + m - 1] = direct
    return LinearSystem(A, B, C, np.zeros((1, 1)), plant.dt)

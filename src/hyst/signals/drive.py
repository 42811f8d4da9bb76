"""A drive: an input designed before the experiment, and what can be said of it in advance."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_positive, whole_number
from hyst.errors import InputError
from hyst.signals.excitation_order import Persistence, persistence

Array = NDArray[np.float64]

MOST_SAMPLES = 100_000_000  # of one drive, 0.8 GB; a number mistyped asks for more

# What rounding may add when limits are met exactly: kept away from them by this share.
_MARGIN = 1e-12


@dataclass(frozen=True, eq=False)
class Limits:
    """What an amplifier and an actuator can stand.

    Parameters
    ----------
    max_rate
        Largest ``|u_k - u_{k-1}| / dt``, units of u per second; infinity for none.
    max_acceleration
        Largest ``|u_k - 2 u_{k-1} + u_{k-2}| / dt^2``, units of u per second squared.

    Raises
    ------
    InputError
        If a limit is not above 0.
    """

    max_rate: float = math.inf
    max_acceleration: float = math.inf

    def __post_init__(self) -> None:
        for name in ("max_rate", "max_acceleration"):
            as_positive(getattr(self, name), name, "a limit", infinite=True)

    def step(self, dt: float, largest: float) -> float:
        """Give the largest change from sample to sample.

        Parameters
        ----------
        dt
            Sample time, s.
        largest
            Largest absolute value, whose rounding is allowed for.
        """
        return self._without_rounding(self.max_rate * dt, largest, "max_rate")

    def bend(self, dt: float, largest: float) -> float:
        """Give the largest change of that change.

        Parameters
        ----------
        dt, largest
            As of ``step``.
        """
        return self._without_rounding(self.max_acceleration * dt**2, largest, "max_acceleration")

    def _without_rounding(self, limit: float, largest: float, name: str) -> float:
        # Four roundings of values that size may add up in a second difference.
        left = limit * (1.0 - _MARGIN) - 4.0 * np.finfo(np.float64).eps * largest
        if left <= 0.0:
            raise InputError(
                f"{name} is {getattr(self, name)}: within one sample that is less than the "
                f"rounding of values up to {largest:.6g}; sample more slowly or raise it"
            )
        return left


@dataclass(frozen=True, eq=False)
class Drive:
    """A designed input; ``numpy.asarray(drive)`` gives its samples.

    Parameters
    ----------
    u
        Shape (N,), input units.
    dt
        Sample time, s.
    kind
        ``multisine``, ``prbs``, ...
    period
        Samples of a period, or 0 if it has none.
    notes
        What was done to meet limits, and what to know; sentences.

    Examples
    --------
    >>> drive = Drive(np.array([0.0, 1.0, 0.0, -1.0]), 0.1, "triangle", 4)
    >>> round(drive.crest_factor, 9), drive.max_rate
    (1.414213562, 10.0)
    """

    u: Array
    dt: float
    kind: str
    period: int = 0
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "u", finite_vector(self.u, "u"))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.u, dtype=dtype)

    def __len__(self) -> int:
        return int(self.u.size)

    @property
    def time(self) -> Array:
        """Time of every sample, s."""
        return np.arange(self.u.size, dtype=np.float64) * self.dt

    @property
    def rms(self) -> float:
        """Root mean square about the mean."""
        return float(self.u.std())

    @property
    def crest_factor(self) -> float:
        """Largest deviation from the mean over the root mean square one; infinity if constant."""
        return float(np.abs(self.u - self.u.mean()).max()) / self.rms if self.rms else math.inf

    @property
    def max_rate(self) -> float:
        """Largest rate from sample to sample, units of u per second."""
        return float(np.abs(np.diff(self.u)).max(initial=0.0)) / self.dt

    @property
    def max_acceleration(self) -> float:
        """Largest second difference over dt squared."""
        return float(np.abs(np.diff(self.u, 2)).max(initial=0.0)) / self.dt**2

    def persistence(self, fir_order: int) -> Persistence:
        """Tell whether the drive determines an impulse response of that order.

        Parameters
        ----------
        fir_order
            mu, the last lag.
        """
        return persistence(self.u, fir_order)


def steps_of(u: Array) -> tuple[float, float]:
    """Give the largest change of a periodic signal from sample to sample, and of that change."""
    # Periodic signals also step from the end to the beginning.
    step = float(np.abs(np.diff(u, append=u[:1])).max(initial=0.0))
    bend = float(np.abs(np.diff(np.concatenate([u, u[:2]]), 2)).max(initial=0.0))
    return step, bend


def fitted(
    u: Array, dt: float, limits: Limits, offset: float = 0.0
) -> tuple[Array, tuple[str, ...]]:
    """Scale a smooth signal without offset down until it meets the limits.

    Parameters
    ----------
    u
        Shape (N,), one period or a whole signal.
    dt
        Sample time, s.
    limits
        Limits.
    offset
        What will be added.

    Returns
    -------
    u : numpy.ndarray
    notes : tuple of str
        By how much it was scaled, and why.
    """
    step, bend = steps_of(u)
    largest = float(np.abs(u).max()) + abs(offset)
    by_rate = limits.step(dt, largest) / step if step > 0.0 else math.inf
    by_acceleration = limits.bend(dt, largest) / bend if bend > 0.0 else math.inf
    factor = min(by_rate, by_acceleration, 1.0)
    if factor == 1.0:
        return u, ()
    which = "rate" if by_rate <= by_acceleration else "acceleration"
    return factor * u, (
        f"scaled to {factor:.4g} of the amplitude asked for, to meet the limit of the {which}; "
        "a lower band would allow more",
    )


def as_count(value: int, name: str, least: int = 1) -> int:
    """Check a number of samples, or of what takes some; a drive may have so many.

    Parameters
    ----------
    value
        A whole number.
    name
        What messages call it.
    least
        The smallest that is allowed.

    Raises
    ------
    InputError
        If it is no whole number, is below ``least``, or more than a drive may have samples.
    """
    count = whole_number(value, name, least)
    require_length(count)
    return count


def require_length(samples: float) -> None:
    """Refuse a drive that is too long, before it is made.

    Parameters
    ----------
    samples
        How many it would have at least.

    Raises
    ------
    InputError
        If there are more than 1e8.
    """
    if samples > MOST_SAMPLES:
        raise InputError(
            f"the drive would have {samples:.4g} samples, and at most {MOST_SAMPLES:.0e} are made; "
            "give a shorter duration, fewer periods, a higher rate of change, or sample more slowly"
        )

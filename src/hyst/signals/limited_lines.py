"""Shape a spectrum until the drive obeys its limits, and keep its amplitude.

Limits of rate and acceleration are limits of ``f a`` and ``f^2 a``: lines above a corner fall as
1/f, those above another as 1/f^2, and none below is touched.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.signals.drive import Limits, steps_of

Array = NDArray[np.float64]

_TURNS = 3
_SAME_CORNER = 1e-4  # of a frequency
_LARGEST_POWER = 30.0
_SAME_POWER = 1e-3
_SMALL = 1e-2  # of the largest line: what is below hardly excites


@dataclass(frozen=True, eq=False)
class Lines:
    """One period of a drive by its lines.

    Parameters
    ----------
    numbers
        Shape (m,), multiples of ``1 / (count dt)``, ascending.
    sizes
        Shape (m,), amplitudes to one another, before limits.
    count, dt
        Samples of the period and sample time, s.
    sized
        Gives the factor that brings a period to its amplitude, or rms.
    offset
        What will be added, for rounding.
    """

    numbers: NDArray[np.intp]
    sizes: Array
    count: int
    dt: float
    sized: Callable[[Array], float]
    offset: float = 0.0

    @property
    def frequency(self) -> Array:
        """Frequency of the lines, Hz."""
        return self.numbers / (self.count * self.dt)

    def wave(self, sizes: Array, phases: Array) -> Array:
        """Give one period of the amplitude asked for, shape (count,).

        Parameters
        ----------
        sizes, phases
            Shape (m,), amplitudes to one another, and radians.
        """
        spectrum = np.zeros(self.count // 2 + 1, dtype=np.complex128)
        spectrum[self.numbers] = sizes * np.exp(1j * phases)
        period = np.fft.irfft(spectrum, self.count)
        return np.asarray(period * self.sized(period))

    def excess(self, u: Array, limits: Limits) -> tuple[float, float]:
        """Give rate and acceleration of a period as shares of what is allowed.

        Parameters
        ----------
        u
            Shape (count,), without offset.
        limits
            Limits.
        """
        step, bend = steps_of(u)
        largest = float(np.abs(u).max()) + abs(self.offset)
        return (
            step / limits.step(self.dt, largest),
            bend / limits.bend(self.dt, largest),
        )


@dataclass(frozen=True)
class Corners:
    """Where lines begin to fall, Hz; infinity for nowhere.

    Parameters
    ----------
    rate, acceleration
        From there as 1/f, and as 1/f^2.
    power
        Of 1/f by which all lines fall, where corners do not do.
    """

    rate: float = math.inf
    acceleration: float = math.inf
    power: float = 0.0

    def shape(self, frequency: Array) -> Array:
        """Give the factors of lines, shape (m,).

        Parameters
        ----------
        frequency
            Shape (m,), Hz, ascending.
        """
        fall = np.minimum(self.rate / frequency, np.square(self.acceleration / frequency))
        slope = (frequency[0] / frequency) ** self.power
        return np.asarray(np.minimum(1.0, fall) * slope)


def shaped(lines: Lines, phases: Array, limits: Limits) -> Corners:
    """Find the highest corners with which a drive of these phases obeys its limits.

    Parameters
    ----------
    lines
        The lines before limits.
    phases
        Shape (m,).
    limits
        Limits.

    Raises
    ------
    InputError
        If even the lowest line alone, at that amplitude, is beyond a limit.
    """

    def beyond(corners: Corners) -> tuple[float, float]:
        sizes = lines.sizes * corners.shape(lines.frequency)
        return lines.excess(lines.wave(sizes, phases), limits)

    corners = Corners()
    for _ in range(_TURNS):  # a corner of one limit moves what the other one asks for
        if beyond(corners)[0] > 1.0:
            corners = _highest(lines, corners, "rate", lambda c: beyond(c)[0])
        if beyond(corners)[1] > 1.0:
            corners = _highest(lines, corners, "acceleration", lambda c: beyond(c)[1])
        if max(beyond(corners)) <= 1.0:
            return corners
    corners = _least_power(lambda c: max(beyond(c)))
    if max(beyond(corners)) > 1.0:
        raise InputError(_too_fast(lines, phases, limits))
    return corners


def said_of(corners: Corners, lines: Lines) -> tuple[str, ...]:
    """Say what was done to the lines to obey the limits.

    Parameters
    ----------
    corners
        What was done.
    lines
        The lines before.
    """
    if corners == Corners():
        return ()
    frequency = lines.frequency
    parts = []
    if math.isfinite(corners.rate):
        parts.append(f"lines above {corners.rate:.4g} Hz fall as 1/f for the limit of the rate")
    if math.isfinite(corners.acceleration):
        parts.append(
            f"lines above {corners.acceleration:.4g} Hz fall as 1/f^2 for the limit of the "
            "acceleration"
        )
    if corners.power > 0.0:
        parts.append(f"all lines fall as 1/f^{corners.power:.3g} for the limits")
    sizes = lines.sizes * corners.shape(frequency)
    large = frequency[sizes >= _SMALL * sizes.max()]
    parts.append(
        f"of the band up to {frequency[-1]:.4g} Hz the lines up to {large[-1]:.4g} Hz have 1 % of "
        "the largest line or more"
    )
    return ("the amplitude is kept and the spectrum shaped: " + "; ".join(parts),)


def _highest(
    lines: Lines, corners: Corners, which: str, beyond: Callable[[Corners], float]
) -> Corners:
    """Move one corner to the highest frequency within a limit, or to the lowest line."""
    frequency = lines.frequency
    low, high = math.log(float(frequency[0])), math.log(2.0 * float(frequency[-1]))
    best = replace(corners, **{which: float(frequency[0])})
    if beyond(best) > 1.0:
        return best
    while high - low > _SAME_CORNER:
        middle = 0.5 * (low + high)
        tried = replace(corners, **{which: math.exp(middle)})
        if beyond(tried) <= 1.0:
            low, best = middle, tried
        else:
            high = middle
    return best


def _least_power(beyond: Callable[[Corners], float]) -> Corners:
    """Let all lines fall no more than it takes, or as much as leaves the lowest alone."""
    low, high, best = 0.0, _LARGEST_POWER, Corners(power=_LARGEST_POWER)
    while high - low > _SAME_POWER and beyond(best) <= 1.0:
        middle = 0.5 * (low + high)
        tried = Corners(power=middle)
        if beyond(tried) <= 1.0:
            high, best = middle, tried
        else:
            low = middle
    return best


def _too_fast(lines: Lines, phases: Array, limits: Limits) -> str:
    """Say by how much even the slowest line is beyond the limits."""
    alone = np.where(np.arange(lines.numbers.size) == 0, 1.0, 0.0)
    u = lines.wave(alone, phases)
    step, bend = steps_of(u)
    rate, acceleration = lines.excess(u, limits)
    which, has, allowed = (
        ("max_rate", step / lines.dt, limits.max_rate)
        if rate >= acceleration
        else ("max_acceleration", bend / lines.dt**2, limits.max_acceleration)
    )
    amplitude = float(np.abs(u).max())
    return (
        f"{which} is {allowed:.6g}, but a sine of amplitude {amplitude:.4g} at "
        f"{lines.frequency[0]:.4g} Hz, the lowest line, needs {has:.4g}; lower the amplitude to "
        f"{amplitude / max(rate, acceleration):.3g}, begin the band lower, or keep the spectrum, "
        "which scales the drive down"
    )

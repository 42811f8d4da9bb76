"""A simulated piezo stage that is, on purpose, none of the models hyst identifies.

Its amplifier lags; its hysteresis has forty plays with an exponential density, followed by a cubic;
it creeps by the logarithm of time; its frame has a lightly damped resonance; its sensor adds noise
and counts in 16 bits. So what hyst finds is an approximation, as it is with a real stage.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter, lfiltic

from hyst.models import PrandtlIshlinskii

Array = NDArray[np.float64]

HIGHEST_DRIVE = 100.0
"""V."""

_PLAYS = 40
_LARGEST_RADIUS = 60.0
_DECAY = 18.0
_LINEAR_SHARE = 0.62

_CREEP_TIMES = tuple(0.03 * math.exp(0.9 * i) for i in range(6))
"""s; so close that their sum is a straight line over the logarithm of time."""


@dataclass(frozen=True, eq=False)
class SimulatedStage:
    """A simulated stage for drives of 0 to 100 V.

    Parameters
    ----------
    dt
        Sample time, s.
    resonance
        Frequency of the frame's resonance, Hz.
    damping
        Its damping ratio.
    lag
        Time constant of the amplifier, s.
    creep
        Share of a step by which the stage goes on in every decade of time, up to some seconds.
    noise
        Standard deviation of the sensor's noise, um.
    count
        What one count of the sensor means, um; 16 bits over 80 um.
    seed
        Of the noise.

    Examples
    --------
    >>> stage = SimulatedStage()
    >>> x = stage.position(np.full(200, 50.0))
    >>> bool(20.0 < x[-1] < 30.0)
    True
    """

    dt: float = 2e-3
    resonance: float = 150.0
    damping: float = 0.03
    lag: float = 4e-4
    creep: float = 0.012
    noise: float = 0.02
    count: float = 80.0 / 2**16
    seed: int = 1
    _hysteresis: PrandtlIshlinskii = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_hysteresis", _bank())

    def position(self, u: Array, history: Array | None = None) -> Array:
        """Give the true position for a drive; only a simulation knows it.

        Parameters
        ----------
        u
            Drive, shape (N,), V.
        history
            Drive before, slow enough for the frame to follow; left out, the stage is new.

        Returns
        -------
        numpy.ndarray
            Shape (N,), um.
        """
        before = np.empty(0) if history is None else history
        drive = self._amplifier(np.concatenate([before, u]))
        force = self._crept(_saturating(self._hysteresis(drive)))
        return self._frame(force[before.size :])

    def measure(self, position: Array) -> Array:
        """Give what the sensor says about a position.

        Parameters
        ----------
        position
            Shape (N,), um.

        Returns
        -------
        numpy.ndarray
            Shape (N,), um, in whole counts. The same noise at every call.
        """
        noise = np.random.default_rng(self.seed).normal(0.0, self.noise, position.size)
        counts: Array = np.round((position + noise) / self.count) * self.count
        return counts

    def _amplifier(self, u: Array) -> Array:
        """First-order lag of a held command, seen as the hold ends; at rest before the first."""
        return _lagging(u, self.lag, self.dt, rest=float(u[0]))

    def _crept(self, force: Array) -> Array:
        """Add lags at many time constants, all at rest at 0 in a new stage."""
        share = self.creep * math.log(_CREEP_TIMES[1] / _CREEP_TIMES[0]) / math.log(10.0)
        lags = [_lagging(force, tau, self.dt) for tau in _CREEP_TIMES]
        return np.asarray(force + share * np.sum(lags, axis=0))

    def _frame(self, force: Array) -> Array:
        """Second-order resonance with unit static gain, held input, at rest at the first sample."""
        numerator, denominator = _resonance(self.resonance, self.damping, self.dt)
        start = lfiltic(numerator, denominator, [force[0]] * 2, [force[0]] * 2)
        filtered: Array = lfilter(numerator, denominator, force, zi=start)[0]
        return filtered


def _lagging(signal: Array, tau: float, dt: float, rest: float = 0.0) -> Array:
    """Follow a held signal with a first-order lag."""
    kept = math.exp(-dt / tau)
    followed: Array = lfilter([1.0 - kept], [1.0, -kept], signal, zi=[kept * rest])[0]
    return followed


def _bank() -> PrandtlIshlinskii:
    """Forty plays, weights falling exponentially with the radius; output in V."""
    r = _LARGEST_RADIUS * np.arange(1, _PLAYS + 1) / _PLAYS
    p = np.exp(-r / _DECAY)
    return PrandtlIshlinskii((1.0 - _LINEAR_SHARE) * p / p.sum(), r, _LINEAR_SHARE)


def _saturating(v: Array) -> Array:
    """Cubic from the bank's output, V, to the force on the frame, um; strictly rising."""
    s = v / HIGHEST_DRIVE
    force: Array = 44.0 * (s + 0.35 * s**2 - 0.1 * s**3)
    return force


def _resonance(frequency: float, damping: float, dt: float) -> tuple[Array, Array]:
    """Zero-order hold of w^2 / (s^2 + 2 damping w s + w^2)."""
    w = 2.0 * math.pi * frequency
    decay = math.exp(-damping * w * dt)
    turn = w * math.sqrt(1.0 - damping**2) * dt
    lean = damping / math.sqrt(1.0 - damping**2) * math.sin(turn)
    numerator = np.array(
        [
            0.0,
            1.0 - decay * (math.cos(turn) + lean),
            decay * (decay - math.cos(turn) + lean),
        ]
    )
    return numerator, np.array([1.0, -2.0 * decay * math.cos(turn), decay**2])

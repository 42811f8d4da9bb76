"""Integral, PI and PID controllers with notches, as responses and as systems.

``C(s) = ki (1 + Ti s + Ti Td s^2 / (Tf s + 1)) / s  prod N_i(s)``,
``N(s) = (s^2 + 2 d1 w s + w^2) / (s^2 + 2 d2 w s + w^2)``. Sampled by the trapezoidal rule, C is
met at ``s = j 2 / dt tan(w dt / 2)``; notches are placed so that they end up where they should.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem, in_series
from hyst.models.realizations import companion

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Notch:
    """A notch, which takes a resonance out of the loop.

    Parameters
    ----------
    frequency
        Where it acts, rad/s.
    zero_damping, pole_damping
        d1 and d2; its depth is d1 / d2, its width grows with d2.
    """

    frequency: float
    zero_damping: float
    pole_damping: float

    def response(self, s: ComplexArray, dt: float) -> ComplexArray:
        """Values at points of the continuous controller, which sampling at dt warps.

        Parameters
        ----------
        s
            Points, as ``controller_points`` gives them.
        dt
            Sample time, s, or 0.
        """
        w = warped(self.frequency, dt)
        square = s * s + w * w
        return np.asarray(
            (square + 2.0 * self.zero_damping * w * s) / (square + 2.0 * self.pole_damping * w * s)
        )


@dataclass(frozen=True)
class Shape:
    """All of a controller but its gain.

    Parameters
    ----------
    Ti, Td, Tf
        Times, s; 0 where the part is absent.
    notches
        In the order they were added.
    """

    Ti: float = 0.0
    Td: float = 0.0
    Tf: float = 0.0
    notches: tuple[Notch, ...] = ()

    def response(self, s: ComplexArray, dt: float) -> ComplexArray:
        """Values of ``C / ki`` at points of the continuous controller, 0 left out.

        Parameters
        ----------
        s
            Points, as ``controller_points`` gives them.
        dt
            Sample time, s, or 0.
        """
        found = times_response(s, np.array([[self.Ti, self.Td, self.Tf]]))[0]
        for notch in self.notches:
            found = found * notch.response(s, dt)
        return np.asarray(found)

    def system(self, ki: float, dt: float) -> LinearSystem:
        """Give the continuous controller whose trapezoidal sampling at dt is meant.

        Parameters
        ----------
        ki
            Integral gain.
        dt
            Sample time, s, or 0.
        """
        above = np.array([self.Ti, 1.0]) if self.Ti else np.array([1.0])
        below = np.array([1.0, 0.0])
        if self.Td:
            above = np.polyadd(np.polymul(above, [self.Tf, 1.0]), [self.Ti * self.Td, 0.0, 0.0])
            below = np.array([self.Tf, 1.0, 0.0])
        parts = [_realized(ki * above, below)]
        for notch in self.notches:
            w = warped(notch.frequency, dt)
            parts.append(
                _realized(
                    np.array([1.0, 2.0 * notch.zero_damping * w, w * w]),
                    np.array([1.0, 2.0 * notch.pole_damping * w, w * w]),
                )
            )
        return in_series(*parts)


def times_response(s: ComplexArray, times: Array) -> ComplexArray:
    """Give ``C / ki`` without notches for rows of Ti, Td, Tf: shape (rows, points).

    Parameters
    ----------
    s
        Points, as ``controller_points`` gives them.
    times
        Shape (rows, 3), s.
    """
    Ti, Td, Tf = times[:, :1], times[:, 1:2], times[:, 2:]
    return np.asarray((1.0 + Ti * s + Ti * Td * s * s / (Tf * s + 1.0)) / s)


def controller_points(w: Array, dt: float) -> ComplexArray:
    """Give where the continuous controller is met at frequencies, rad/s, below Nyquist.

    Parameters
    ----------
    w
        Frequencies, rad/s.
    dt
        Sample time, s, or 0.
    """
    if not dt:
        return np.asarray(1j * w)
    # At Nyquist itself the tangent is infinite; a millionth below it nothing has changed yet.
    angle = np.minimum(0.5 * w * dt, 0.5 * math.pi * (1.0 - 1e-6))
    return np.asarray(2j / dt * np.tan(angle))


def warped(w: float, dt: float) -> float:
    """Give the frequency of a continuous system which the trapezoidal rule moves to w.

    Parameters
    ----------
    w
        Frequency, rad/s, below pi/dt.
    dt
        Sample time, s, or 0.
    """
    return 2.0 / dt * math.tan(0.5 * w * dt) if dt else w


def _realized(above: Array, below: Array) -> LinearSystem:
    A, B, C, D = companion(above, below)
    return LinearSystem(A, B.reshape(-1, 1), C.reshape(1, -1), np.array([[D]]))

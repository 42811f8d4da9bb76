"""Is a loop stable: by its poles, or with dead time in continuous time by Nyquist's criterion."""

from __future__ import annotations

import math

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.feedback.frequencies import frequencies_around
from hyst.control.feedback.loop_plant import LoopPlant, as_rates, points
from hyst.control.linear_system import LinearSystem
from hyst.errors import InputError, SolverError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_TURN = 0.5  # rad between neighbouring points of a Nyquist curve
_ROUNDS = 40


def loop_poles(plant: LinearSystem, controller: LinearSystem) -> ComplexArray:
    """Give the poles of the loop ``v = -C y, y = P v``.

    Parameters
    ----------
    plant, controller
        Both continuous or both sampled.

    Raises
    ------
    InputError
        If what feeds through the loop leaves no solution.
    """
    share = 1.0 + float(plant.D[0, 0] * controller.D[0, 0])
    if abs(share) < 1e-12:
        raise InputError("the feedthrough round the loop is 1, so it has no solution; add a pole")
    n, m = plant.order, controller.order
    A = scipy.linalg.block_diag(plant.A, controller.A) if n + m else np.zeros((0, 0))
    A = A.reshape(n + m, n + m)
    into = np.vstack([plant.B, np.zeros((m, 1))]), np.vstack([np.zeros((n, 1)), -controller.B])
    v = np.hstack([-controller.D @ plant.C, controller.C]) / share
    y = np.hstack([plant.C, plant.D @ controller.C]) / share
    return np.asarray(np.linalg.eigvals(A + into[0] @ v + into[1] @ y), dtype=np.complex128)


def pole_margin(poles: ComplexArray, dt: float) -> float:
    """Give how far the least stable pole is from unstable: 1 - |z|, or -Re s; below 0 it is.

    Parameters
    ----------
    poles
        In s or z.
    dt
        Sample time, s; 0 in continuous time.
    """
    if poles.size == 0:
        return math.inf
    return float((1.0 - np.abs(poles)).min() if dt else -poles.real.max())


def is_stable(plant: LoopPlant, controller: LinearSystem) -> bool:
    """Tell whether the loop of plant and controller is stable.

    Parameters
    ----------
    plant
        With its dead time.
    controller
        Continuous for a continuous plant, else sampled with its dt.

    Raises
    ------
    InputError
        If what feeds through the loop leaves no solution.
    SolverError
        If the Nyquist curve passes too near -1 to be followed.
    """
    if plant.delay == 0.0:
        return pole_margin(loop_poles(plant.system, controller), plant.dt) > 0.0
    return _encircles_nothing(plant, controller)


def _encircles_nothing(plant: LoopPlant, controller: LinearSystem) -> bool:
    """From 0 to infinity the phase of 1 + L turns by a quarter for each integrator, if stable."""
    feed = abs(float(plant.system.D[0, 0] * controller.D[0, 0]))
    if feed >= 1.0:
        return False
    rates = np.concatenate([as_rates(plant.system), as_rates(controller)])
    scale = float(np.abs(rates).max(initial=0.0)) or 1.0 / plant.delay
    at_origin = int(np.sum(np.abs(rates) <= 1e-9 * scale))
    if (rates.real > 1e-9 * scale).any():
        raise InputError("the controller is unstable; give a stable one")

    def around(w: Array) -> ComplexArray:
        s = points(w, 0.0)
        return np.asarray(1.0 + plant.response(w) * controller.response(s)[:, 0, 0])

    w = frequencies_around(np.append(rates, 1.0 / plant.delay), np.inf)
    # Beyond the last |L| that matters, 1 + L stays in the right half plane.
    loud = np.flatnonzero(np.abs(around(w) - 1.0) > 0.5 * (1.0 + feed))
    w = w[: int(loud[-1]) + 2] if loud.size else w[:2]
    values = around(w)
    for _ in range(_ROUNDS):
        turns = np.abs(np.angle(values[1:] / values[:-1]))
        coarse = np.flatnonzero(turns > _TURN)
        if coarse.size == 0:
            break
        extra = 0.5 * (w[coarse] + w[coarse + 1])
        w, values = np.append(w, extra), np.append(values, around(extra))
        order = np.argsort(w)
        w, values = w[order], values[order]
    else:
        raise SolverError("the loop is on the border of stability; change a gain a little")
    first = values[0] * 1j**at_origin  # near the positive real axis where the static gain is right
    if first.real <= 0.0:
        return False
    turned = float(np.sum(np.angle(values[1:] / values[:-1])))
    turned += float(np.angle(first)) - float(np.angle(values[-1]))
    return abs(turned - 0.5 * np.pi * at_origin) < 1.0  # off by whole turns, or by rounding

"""The linear part of the loop of S1 Fig. 2 as one system."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.discretization import held
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import InputError
from hyst.models import LinearDynamics

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def plant_of(system: Any, name: str = "the plant") -> LinearSystem:
    """Read a plant.

    Parameters
    ----------
    system
        As ``as_linear_system`` takes it, or LinearDynamics with its delay.
    name
        What messages call it.

    Returns
    -------
    LinearSystem

    Raises
    ------
    InputError
        If it cannot be read, is improper, has not one input and one output, or has a pole that
        grows.
    """
    read = (
        _with_delay(system)
        if isinstance(system, LinearDynamics)
        else as_linear_system(system, name)
    )
    if (read.inputs, read.outputs) != (1, 1):
        raise InputError(
            f"{name} has {read.inputs} inputs and {read.outputs} outputs; "
            "give a system from the output of the hysteresis to y"
        )
    poles = read.poles()
    growth = np.abs(poles) - 1.0 if read.dt > 0.0 else poles.real
    # Rounding moves a double pole at the origin by the root of the machine precision.
    if read.order and growth.max() > 1e-7 * max(1.0, float(np.abs(poles).max())):
        worst = complex(poles[int(np.argmax(growth))])
        raise InputError(f"{name} is unstable: it has the pole {worst:.6g}; give a stable plant")
    return read


def continuous_loop(plant: LinearSystem, part: LinearSystem) -> LinearSystem:
    """Close the linear paths of the loop, and leave it open at the hysteresis.

    Parameters
    ----------
    plant
        From w to y.
    part
        From (y_ref, y) to (v, d_hat), as ``joined`` gives it.

    Returns
    -------
    LinearSystem
        Inputs r, noise and w, outputs v, y and d_hat; states of the controller first.

    Raises
    ------
    InputError
        If one of them is sampled.
    """
    for name, each in (("the plant", plant), ("controller or observer", part)):
        if each.dt > 0.0:
            raise InputError(
                f"{name} is sampled; give continuous systems, or as controller a "
                "TrackingController, which goes with either kind of plant"
            )
    m, n = part.order, plant.order
    A = np.zeros((m + n, m + n))
    A[:m, :m], A[:m, m:], A[m:, m:] = part.A, part.B[:, 1:] @ plant.C, plant.A
    B = np.zeros((m + n, 3))
    B[:m] = _through_sum(part.B, plant)
    B[m:, 2:] = plant.B
    C, D = np.zeros((3, m + n)), np.zeros((3, 3))
    C[[0, 2], :m], C[[0, 2], m:] = part.C, part.D[:, 1:] @ plant.C
    D[[0, 2]] = _through_sum(part.D, plant)
    C[1, m:], D[1, 2] = plant.C[0], plant.D[0, 0]
    return LinearSystem(A, B, C, D)


def held_step(system: LinearSystem, dt: float) -> Array:
    """Give one step of a system whose inputs are held: ``[x+; y] = step [x; u]``.

    Parameters
    ----------
    system
        Continuous, or sampled with this dt.
    dt
        Sample time, s.

    Returns
    -------
    numpy.ndarray
        Shape (n + outputs, n + inputs).

    Raises
    ------
    InputError
        If it is sampled with another dt.
    """
    if system.dt > 0.0 and abs(system.dt - dt) > 1e-6 * dt:
        raise InputError(
            f"the plant has dt = {system.dt:.6g} s, the loop {dt:.6g} s; give the same for both"
        )
    if system.dt > 0.0:
        A, B, C, D = system.A, system.B, system.C, system.D
    else:
        A, B, C, D = held(system, dt)
    return np.ascontiguousarray(np.block([[A, B], [C, D]]))


def _through_sum(matrix: Array, plant: LinearSystem) -> Array:
    """Columns of (y_ref, y) become those of (r, noise, w), for y = C x + D w + noise."""
    return np.hstack([matrix, matrix[:, 1:] * plant.D[0, 0]])


def _with_delay(dynamics: LinearDynamics) -> LinearSystem:
    n, d = dynamics.order, dynamics.delay
    if d == 0:
        return LinearSystem(
            dynamics.A, dynamics.B, dynamics.C, np.array([[dynamics.D]]), dynamics.dt
        )
    A, B, C = np.zeros((n + d, n + d)), np.zeros(n + d), np.zeros(n + d)
    A[:n, :n], A[:n, n], C[:n], C[n] = dynamics.A, dynamics.B, dynamics.C, dynamics.D
    A[np.arange(n, n + d - 1), np.arange(n + 1, n + d)] = 1.0
    B[-1] = 1.0
    return LinearSystem(A, B, C, np.zeros((1, 1)), dynamics.dt)

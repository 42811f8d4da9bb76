"""The linear part of the loop of S1 Fig. 2 as one system."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.controller_parts import disturbance_observer_of, feedback_controller, joined
from hyst.control.discretization import held
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.tracking_controller import TrackingController
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


def closed_loop_poles(plant: Any, controller: Any, observer: Any = None) -> ComplexArray:
    """Give the poles of the loop in which the inverse cancels the hysteresis perfectly.

    With a TrackingController these are poles of the sampled loop.

    Parameters
    ----------
    plant, controller, observer
        As in ``simulate_closed_loop``.

    Returns
    -------
    numpy.ndarray
        The least stable first: the largest real part, or the largest modulus.

    Raises
    ------
    InputError
        If a block cannot be used.

    Examples
    --------
    >>> closed_loop_poles(([1.0], [1.0, 1.0]), 4.0).real.round(9).tolist()
    [-5.0]
    """
    process = plant_of(plant)
    if isinstance(controller, TrackingController):
        poles = _sampled_poles(held_step(process, controller.dt), controller)
        return np.asarray(poles[np.argsort(-np.abs(poles))])
    part = joined(feedback_controller(controller), disturbance_observer_of(observer))
    loop = continuous_loop(process, part)
    share = 1.0 - loop.D[0, 2]
    if abs(share) < 1e-12:
        raise InputError("the feedthrough round the loop is 1, so it has no solution; add a pole")
    poles = np.linalg.eigvals(loop.A + np.outer(loop.B[:, 2], loop.C[0]) / share)
    return np.asarray(poles[np.argsort(-poles.real)], dtype=np.complex128)


def _sampled_poles(step: Array, controller: TrackingController) -> ComplexArray:
    """At sample k the controller is given y before its new drive acts, hence w one sample old."""
    n, m = step.shape[0] - 1, controller.order
    Ap, Bp, Cp, feedthrough = step[:n, :n], step[:n, n], step[n, :n], step[n, n]
    A = np.zeros((m + n + 1, m + n + 1))
    y = np.concatenate([np.zeros(m), Cp, [feedthrough]])
    v = np.concatenate([controller.C, np.zeros(n + 1)]) + controller.D[1] * y
    A[:m, :m] = controller.A
    A[:m] += np.outer(controller.B[:, 1], y)
    A[m : m + n, m : m + n] = Ap
    A[m : m + n] += np.outer(Bp, v)
    A[-1] = v
    size = m + n + 1 if feedthrough else m + n
    return np.asarray(np.linalg.eigvals(A[:size, :size]), dtype=np.complex128)


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

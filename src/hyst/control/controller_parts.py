"""Feedback controller and disturbance observer joined into one linear system."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import InputError

Array = NDArray[np.float64]


def feedback_controller(system: Any) -> LinearSystem:
    """Read C: tracking error in, wanted input of the plant out.

    Parameters
    ----------
    system
        As ``as_linear_system`` takes it, or a design that has it as ``controller``; None is a gain
        of one.

    Returns
    -------
    LinearSystem

    Raises
    ------
    InputError
        If it cannot be read, is improper, or has not one input and one output.
    """
    given = getattr(system, "controller", system)  # of a design
    read = as_linear_system(1.0 if given is None else given, "the controller")
    if (read.inputs, read.outputs) != (1, 1):
        raise InputError(
            f"the controller has {read.inputs} inputs and {read.outputs} outputs; "
            "give a system from the tracking error to the plant's input"
        )
    return read


def disturbance_observer_of(system: Any) -> LinearSystem:
    """Read the observer of S1 eq. 32: inputs v and y, output the estimate of the disturbance.

    Parameters
    ----------
    system
        As ``as_linear_system`` takes it, or an object with such a system as ``observer``; None is
        an observer that always estimates zero.

    Returns
    -------
    LinearSystem

    Raises
    ------
    InputError
        If it cannot be read, is unstable, or has not two inputs and one output.
    """
    if system is None:
        return LinearSystem(np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.zeros((1, 2)))
    read = as_linear_system(getattr(system, "observer", system), "the observer")
    if (read.inputs, read.outputs) != (2, 1):
        raise InputError(
            f"the observer has {read.inputs} inputs and {read.outputs} outputs; "
            "give a system from (v, y) to the estimate of the disturbance"
        )
    refuse_unstable(read, "the observer")
    return read


def refuse_unstable(system: LinearSystem, name: str) -> None:
    """Refuse a block that is unstable by itself.

    Parameters
    ----------
    system
        Continuous or sampled.
    name
        What messages call it.

    Raises
    ------
    InputError
        If a pole does not lie in the open left half plane, or inside the unit circle.
    """
    if system.order == 0:
        return
    poles = system.poles()
    margins = 1.0 - np.abs(poles) if system.dt > 0.0 else -poles.real
    worst = int(np.argmin(margins))
    if margins[worst] <= 0.0:
        raise InputError(
            f"{name} is not stable: it has the pole {complex(poles[worst]):.6g}; give a stable one"
        )


def joined(controller: LinearSystem, observer: LinearSystem) -> LinearSystem:
    """Join controller and observer: ``v = C(y_ref - y) - d_hat``, ``d_hat = observer(v, y)``.

    The observer sees v, from which its own estimate is taken off. Where it has feedthrough from v,
    ``v (1 + D_v) = ...`` is solved here.

    Parameters
    ----------
    controller
        One input, the error, or two, y_ref and y; one output.
    observer
        Two inputs, one output; both continuous, or both sampled with one dt.

    Returns
    -------
    LinearSystem
        Inputs y_ref and y, outputs v and d_hat; states of the controller first.

    Raises
    ------
    InputError
        If the observer's feedthrough from v is -1, so that v is not determined.
    """
    share = 1.0 + float(observer.D[0, 0])
    if abs(share) < 1e-9:
        raise InputError(
            "the observer's feedthrough from v to its estimate is -1, so v is not determined; "
            "give a strictly proper observer"
        )
    A = (
        scipy.linalg.block_diag(controller.A, observer.A)
        if controller.order + observer.order
        else np.zeros((0, 0))
    )
    difference = np.array([[1.0, -1.0]]) if controller.inputs == 1 else np.eye(2)
    only_y = np.array([[0.0, 1.0]])
    B = np.vstack([controller.B @ difference, observer.B[:, 1:] @ only_y])
    into = np.vstack([np.zeros((controller.order, 1)), observer.B[:, :1]])  # of v
    v_of_x = np.hstack([controller.C, -observer.C]) / share
    v_of_in = (controller.D @ difference - observer.D[:, 1:] @ only_y) / share
    d_of_x = np.hstack([np.zeros((1, controller.order)), observer.C])
    C = np.vstack([v_of_x, d_of_x + observer.D[:, :1] @ v_of_x])
    D = np.vstack([v_of_in, observer.D[:, 1:] @ only_y + observer.D[:, :1] @ v_of_in])
    return LinearSystem(A + into @ v_of_x, B + into @ v_of_in, C, D, controller.dt)

"""Poles of the loop in which the inverse is perfect."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.controller_parts import disturbance_observer_of, feedback_controller, joined
from hyst.control.loop_system import continuous_loop, plant_of
from hyst.control.sampled.block_loop import BlockLoop
from hyst.control.sampled.plant import sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError

ComplexArray = NDArray[np.complex128]


def closed_loop_poles(
    plant: Any, controller: Any, observer: Any = None, *, delay: float = 0.0
) -> ComplexArray:
    """Give the poles of the loop in which the inverse cancels the hysteresis perfectly.

    With a TrackingController these are poles of the sampled loop.

    Parameters
    ----------
    plant, controller, observer, delay
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
    if isinstance(controller, TrackingController):
        return BlockLoop(controller, sampled_plant(plant, controller.dt, delay)).poles()
    process = plant_of(plant)
    part = joined(feedback_controller(controller), disturbance_observer_of(observer))
    loop = continuous_loop(process, part)
    share = 1.0 - loop.D[0, 2]
    if abs(share) < 1e-12:
        raise InputError("the feedthrough round the loop is 1, so it has no solution; add a pole")
    poles = np.linalg.eigvals(loop.A + np.outer(loop.B[:, 2], loop.C[0]) / share)
    return np.asarray(poles[np.argsort(-poles.real)], dtype=np.complex128)

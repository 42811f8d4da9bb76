"""Stability of the loop with an inexact inverse: the circle criterion on rates."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hyst.checks.numbers import as_number
from hyst.control.controller_parts import disturbance_observer_of, feedback_controller, joined
from hyst.control.infinity_norm import hinf_norm
from hyst.control.linear_system import LinearSystem
from hyst.control.loop_system import continuous_loop, plant_of
from hyst.errors import InputError

_SLOPES = 200


def slope_margin(plant: Any, controller: Any, observer: Any, slopes: tuple[float, float]) -> float:
    """Tell how many times wider the range of slopes may be before stability is not proven.

    Hysteresis and inverse together are ``dw/dt = k(t) dv/dt`` with k between the slopes low and
    high. With the middle ``c`` of both, the rates of all signals stay bounded in L2 by those of
    reference and noise, so that there is no self-sustained oscillation, if the loop closed with
    the gain c is stable and

        ``||T_c|| (high - low) / 2 < 1``,   T_c from what is added to w to v.

    Parameters
    ----------
    plant, controller, observer
        As in ``closed_loop_poles``, in continuous time; the plant is the true one.
    slopes
        Least and largest slope, as ``slope_range`` gives them.

    Returns
    -------
    float
        ``2 / (||T_c|| (high - low))``: above 1, stability is proven; 0 if the loop with the gain c
        is unstable, infinity if both slopes are the same and it is stable.

    Raises
    ------
    InputError
        If a block cannot be used, or low is above high.

    Notes
    -----
    The criterion is sufficient, not necessary: below 1 the loop may still be stable.

    Examples
    --------
    >>> plant, integrator = ([1.0], [1.0, 1.0]), ([1.0], [1.0, 0.0])
    >>> round(slope_margin(plant, integrator, None, (0.5, 1.5)), 3)
    1.732
    >>> slope_margin(plant, integrator, None, (1.0, 1.0))
    inf
    """
    low, high = _ordered(slopes)
    norm, _ = hinf_norm(_closed(_open(plant, controller, observer), 0.5 * (low + high)))
    if math.isinf(norm):
        return 0.0
    half = 0.5 * (high - low)
    return math.inf if half * norm == 0.0 else 1.0 / (half * norm)


def first_unstable_slope(
    plant: Any, controller: Any, observer: Any, slopes: tuple[float, float]
) -> float | None:
    """Look for slopes of hysteresis after inverse at which the loop is unstable.

    While the plays that move stay the same the loop is linear, with their slope as its gain. Where
    it is unstable for a slope the hysteresis has, small motions there grow into bursts.

    Parameters
    ----------
    plant, controller, observer
        As in ``slope_margin``.
    slopes
        Least and largest slope that the hysteresis after the inverse has.

    Returns
    -------
    float or None
        The least of 200 evenly spaced slopes at which it is unstable; None if it is at none.

    Raises
    ------
    InputError
        If a block cannot be used, or the first slope is above the second.

    Examples
    --------
    >>> plant, integrator = ([1.0], [1.0, 2.0, 1.0]), ([1.0], [1.0, 0.0])
    >>> first_unstable_slope(plant, integrator, None, (0.5, 1.5)) is None
    True
    >>> round(first_unstable_slope(plant, integrator, None, (0.5, 2.5)), 2)
    2.01
    """
    low, high = _ordered(slopes)
    loop = _open(plant, controller, observer)
    for gain in np.linspace(low, high, _SLOPES):
        if (_closed(loop, float(gain)).poles().real >= 0.0).any():
            return float(gain)
    return None


def _ordered(slopes: tuple[float, float]) -> tuple[float, float]:
    low, high = (as_number(each, "slopes") for each in slopes)
    if low > high:
        raise InputError(f"slopes are {low:.6g} and {high:.6g}; give the smaller one first")
    return low, high


def _open(plant: Any, controller: Any, observer: Any) -> LinearSystem:
    part = joined(feedback_controller(controller), disturbance_observer_of(observer))
    return continuous_loop(plant_of(plant), part)


def _closed(loop: LinearSystem, gain: float) -> LinearSystem:
    """Close ``w = gain v + d``: from d to v."""
    b, c, d = loop.B[:, 2:], loop.C[:1], float(loop.D[0, 2])
    share = 1.0 - gain * d
    if abs(share) < 1e-12:
        raise InputError("the feedthrough round the loop is 1, so it has no solution; add a pole")
    return LinearSystem(
        loop.A + gain / share * b @ c, b / share, c / share, np.array([[d / share]])
    )

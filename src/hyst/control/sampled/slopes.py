"""A sampled block with an inexact inverse: slopes of hysteresis after inverse that it bears."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number
from hyst.control.largest_value import largest
from hyst.control.sampled.block_loop import BlockLoop
from hyst.control.sampled.certificate import plant_of_block, stable_weight
from hyst.control.sampled.folding import folded_uncertainty
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_SLOPES = 40


def sampled_slope_proof(
    block: TrackingController,
    plant: Any,
    slopes: tuple[float, float],
    Wu: Any = 0.0,
    *,
    delay: float = 0.0,
) -> tuple[float, float]:
    r"""Tell whether a block is proven stable with an inexact inverse, for every plant within Wu.

    Hysteresis after inverse is ``w_{k+1} - w_k = g_k (v_{k+1} - v_k)`` with each g_k between two
    slopes, ``c - rho`` and ``c + rho``. The differences of all signals stay bounded in l2, for
    every plant within Wu, if the loop with the gain c is stable and

        ``rho |Pd K S_c| + (|c| + rho) a |K S_c| < 1``,   ``S_c = 1 / (1 + c K Pd)``

    at all frequencies up to pi/dt: the circle criterion on differences, of the sampled loop.

    Parameters
    ----------
    block, plant, Wu, delay
        As in ``sampled_certificate``; no uncertainty if Wu is left out.
    slopes
        Least and largest slope of hysteresis after inverse, as ``compensation.slope_range`` gives.

    Returns
    -------
    value, frequency : float
        The largest left-hand side: below 1, the loop is proven stable; infinite if the loop with
        the gain c is unstable. The frequency in rad/s.

    Raises
    ------
    InputError
        As ``sampled_certificate``, or if the first slope is above the second.

    Notes
    -----
    Sufficient, not necessary; with both slopes 1 it is eq. 26, which is both.

    Examples
    --------
    >>> slow = TrackingController.from_continuous(([20.0], [1.0, 0.0]), dt=1e-3)
    >>> stage = ([4e5], [1.0, 40.0, 4e5])
    >>> sampled_slope_proof(slow, stage, (0.8, 1.2), Wu=0.1)[0] < 1.0
    True
    """
    low, high = _ordered(slopes)
    loop, weight = BlockLoop(block, plant_of_block(plant, block, delay)), stable_weight(Wu, "Wu")
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    if np.abs(loop.poles(middle)).max(initial=0.0) >= 1.0:
        return math.inf, 0.0

    def left_hand_side(w: Array) -> Array:
        values = loop.at(w, middle)
        a = folded_uncertainty(loop.plant, weight, w)
        return np.asarray(np.abs(values.N) * (half * np.abs(values.Pd) + (abs(middle) + half) * a))

    return largest(left_hand_side, loop.grid(weight, slope=middle))


def sampled_slope_failing(
    block: TrackingController,
    plant: Any,
    slopes: tuple[float, float],
    Wu: Any = 0.0,
    *,
    delay: float = 0.0,
) -> float | None:
    """Look for a slope of hysteresis after inverse at which some plant within Wu is unstable.

    While the plays that move stay the same the loop is linear, with their slope as its gain g. It
    is stable for every plant within Wu if and only if it is for the nominal one and
    ``|g| a |K S_g| < 1``.

    Parameters
    ----------
    block, plant, slopes, Wu, delay
        As in ``sampled_slope_proof``.

    Returns
    -------
    float or None
        The one of 40 evenly spaced slopes that fails and is closest to 1; None if none does.

    Raises
    ------
    InputError
        As ``sampled_slope_proof``.

    Examples
    --------
    >>> slow = TrackingController.from_continuous(([20.0], [1.0, 0.0]), dt=1e-3)
    >>> stage = ([4e5], [1.0, 40.0, 4e5])
    >>> sampled_slope_failing(slow, stage, (0.5, 1.5)) is None
    True
    >>> sampled_slope_failing(slow, stage, (0.5, 9.0)) is None
    False
    """
    low, high = _ordered(slopes)
    loop, weight = BlockLoop(block, plant_of_block(plant, block, delay)), stable_weight(Wu, "Wu")
    each = np.linspace(low, high, _SLOPES)
    w = loop.grid(weight)
    everywhere = folded_uncertainty(loop.plant, weight, w), *loop.open(w)
    for slope in each[np.argsort(np.abs(each - 1.0))]:
        if np.abs(loop.poles(float(slope))).max(initial=0.0) >= 1.0:
            return float(slope)
        # A resonance that only this slope makes is narrower than the grid.
        own = loop.beside_poles(float(slope))
        beside = folded_uncertainty(loop.plant, weight, own), *loop.open(own)
        if max(_row(float(slope), *everywhere), _row(float(slope), *beside)) >= 1.0:
            return float(slope)
    return None


def _row(slope: float, a: Array, K: ComplexArray, Pd: ComplexArray) -> float:
    """Give the largest ``|g| a |K S_g|``."""
    return float((abs(slope) * a * np.abs(K / (1.0 + slope * K * Pd))).max(initial=0.0))


def _ordered(slopes: tuple[float, float]) -> tuple[float, float]:
    low, high = (as_number(each, "slopes") for each in slopes)
    if low > high:
        raise InputError(f"slopes are {low:.6g} and {high:.6g}; give the smaller one first")
    return low, high

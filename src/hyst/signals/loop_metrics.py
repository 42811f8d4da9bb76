"""Size of a hysteresis loop: its widest opening and its area."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector, same_length
from hyst.checks.numbers import whole_number
from hyst.errors import InputError
from hyst.signals.noise import suggest_dead_band
from hyst.signals.turning_points import reversals

Branch = tuple[NDArray[np.float64], NDArray[np.float64]]


def hysteresis_percent(u: ArrayLike, y: ArrayLike, dead_band: float | None = None) -> float:
    """Measure the widest opening of the loop, in percent of the output range.

        100 max |y_rising(u) - y_falling(u)| / (max y - min y)

    The record is cut at its reversals into branches; each branch is compared with the next one
    over the inputs they share, both taken as straight between samples. The branch before the
    first reversal belongs to the start from rest and not to the loop: it counts only when
    there is nothing else to compare.

    Parameters
    ----------
    u
        Input, shape (N,), finite, with at least one reversal.
    y
        Output, shape (N,), finite, not constant.
    dead_band
        Swings of the input up to this size are noise, units of ``u``, >= 0; by default
        ``suggest_dead_band(u)``.

    Returns
    -------
    float
        Percent of the range of ``y``, 0 for a single-valued curve.

    Raises
    ------
    InputError
        If a signal is not a finite vector, the lengths differ, ``y`` is constant, or the input
        has no reversal.

    Source
    ------
    The hysteresis percent of the rate-dependent measurements of Al Janaideh and Krejci,
    "Inverse rate-dependent Prandtl-Ishlinskii model for feedforward compensation of hysteresis
    in a piezomicropositioning actuator", sec. III.

    Examples
    --------
    >>> hysteresis_percent([0, 1, 2, 1, 0, 1, 2], [0, 1, 4, 3, 0, 1, 4])
    50.0
    """
    inputs, outputs = finite_vector(u, "u"), finite_vector(y, "y")
    same_length(inputs, outputs, "u and y")
    output_range = float(np.ptp(outputs))
    if output_range == 0.0:
        raise InputError(f"y is {outputs[0]} throughout; a loop needs an output that moves")
    turns = reversals(inputs, suggest_dead_band(inputs) if dead_band is None else dead_band)
    if turns.size == 0:
        raise InputError("u has no reversal, so there is no loop; record a rise and a fall")
    ends = [0, *turns.tolist(), inputs.size - 1]
    branches = [
        _monotone(inputs[start : end + 1], outputs[start : end + 1])
        for start, end in pairwise(ends)
    ]
    if len(branches) > 2:
        branches = branches[1:]
    widest = max(_opening(one, other) for one, other in pairwise(branches))
    return 100.0 * widest / output_range


def loop_area(u: ArrayLike, y: ArrayLike, cycles: int = 1) -> float:
    """Measure the area a closed loop encloses, per cycle.

        (1/2) sum_k (u[k] y[k+1] - u[k+1] y[k]) / cycles,   indices modulo N

    This is the area of the polygon through the samples, closed from the last to the first. It
    is positive when the loop is run counterclockwise in the (u, y) plane, that is when the
    output lags the input. For force against displacement it is minus the work put in.

    Parameters
    ----------
    u
        Input, shape (N,), finite: a whole number of cycles.
    y
        Output, shape (N,), finite.
    cycles
        How many cycles the record holds, >= 1.

    Returns
    -------
    float
        Mean area of one cycle, units of u times units of y.

    Raises
    ------
    InputError
        If a signal is not a finite vector, the lengths differ, or ``cycles`` is below 1.

    Examples
    --------
    >>> loop_area([0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 2.0, 2.0])
    2.0
    """
    inputs, outputs = finite_vector(u, "u"), finite_vector(y, "y")
    same_length(inputs, outputs, "u and y")
    whole_number(cycles, "cycles", 1, more=": the cycles in the record")
    # The area does not depend on the origin, but the rounding error does.
    inputs, outputs = inputs - np.mean(inputs), outputs - np.mean(outputs)
    twice = np.dot(inputs, np.roll(outputs, -1)) - np.dot(np.roll(inputs, -1), outputs)
    return float(twice) / (2.0 * cycles)


def _monotone(inputs: NDArray[np.float64], outputs: NDArray[np.float64]) -> Branch:
    """Branch with strictly increasing inputs: samples where noise stepped back are left out."""
    if inputs[-1] < inputs[0]:
        inputs, outputs = inputs[::-1], outputs[::-1]
    ahead = np.append(True, inputs[1:] > np.maximum.accumulate(inputs)[:-1])
    return inputs[ahead], outputs[ahead]


def _opening(one: Branch, other: Branch) -> float:
    """Largest vertical distance of two branches; straight pieces differ most at a corner."""
    low, high = max(one[0][0], other[0][0]), min(one[0][-1], other[0][-1])
    corners = np.concatenate((one[0], other[0], [low, high]))
    corners = corners[(corners >= low) & (corners <= high)]
    gap = np.interp(corners, *one) - np.interp(corners, *other)
    return float(np.max(np.abs(gap), initial=0.0))

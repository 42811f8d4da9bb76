"""Search for the shape of a controller that bears the largest integral gain."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.control.feedback.gain_bounds import (
    gain_for_gain_margin,
    gain_for_phase,
    gain_for_sensitivity,
    gain_for_uncertainty,
)
from hyst.control.feedback.resonances import Resonance
from hyst.control.feedback.structures import Notch, Shape, times_response

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_DERIVATIVE_FILTER = 8.0  # Td / Tf
_WORTH = 1.15  # a further notch has to allow this much more gain
_MOST_NOTCHES = 4
_POLE_DAMPINGS = (0.3, 0.6, 1.0)
_SHIFTS = (1.0, 0.95, 1.05)
_MORE, _DEGREES = 1.003, 0.5  # asked for on the grid, so that what lies between is kept too
_EXTREMES = 3  # plants: the nominal one and those at the ends of the mismatch


@dataclass(frozen=True, eq=False)
class Demands:
    """What a loop has to keep, on a grid of frequencies and for each of some plants.

    Parameters
    ----------
    s
        Points of the continuous controller, shape (K,).
    plants
        Responses, shape (plants, K), each times the sign of the static gain.
    dt
        Sample time, s, or 0.
    peak
        Ms.
    gain_margin, phase_margin
        Factor and degrees, or None.
    noise_gain
        Bound of |C S|, in units of v per unit of y.
    deviation
        By how much the first plant may be off, |P Wu|, shape (K,), or None.
    """

    s: ComplexArray
    plants: ComplexArray
    dt: float
    peak: float
    gain_margin: float | None
    phase_margin: float | None
    noise_gain: float
    deviation: Array | None

    def noise_gains(self, controller: ComplexArray) -> Array:
        """Give ``|C S|`` of each plant on the grid, shape (plants, K).

        Parameters
        ----------
        controller
            Response of C times the sign of the static gain, shape (K,).
        """
        return np.asarray(np.abs(controller / (1.0 + self.plants * controller)))

    def largest_gain(self, shapes: ComplexArray, most: int | None = None) -> Array:
        """Give the largest ki for responses of C / ki, shape (shapes, K).

        Parameters
        ----------
        shapes
            The responses.
        most
            How many of the plants count, the first ones; all if left out.
        """
        best = np.full(len(shapes), np.inf)
        for plant in self.plants[:most]:
            loop = shapes * plant
            best = np.minimum(best, gain_for_sensitivity(loop, self.peak))
            noise = gain_for_uncertainty(loop, shapes / self.noise_gain)
            best = np.minimum(best, noise)
            if self.gain_margin is not None:
                best = np.minimum(best, gain_for_gain_margin(loop, _MORE * self.gain_margin))
            if self.phase_margin is not None:
                best = np.minimum(best, gain_for_phase(loop, self.phase_margin + _DEGREES))
        if self.deviation is not None:
            loop = shapes * self.plants[0]
            best = np.minimum(best, gain_for_uncertainty(loop, shapes * self.deviation))
        return np.where(np.isfinite(best), best, 0.0)


def best_shape(
    demands: Demands, kind: str, times: Array, found: tuple[Resonance, ...], needed: bool
) -> tuple[Shape, float]:
    """Give the shape of one kind with the largest integral gain, and that gain.

    Parameters
    ----------
    demands
        What the loop has to keep.
    kind
        ``i``, ``pi`` or ``pid``.
    times
        Candidates for Ti and Td, s, ascending.
    found
        Resonances that may get a notch, none for no notch.
    needed
        Whether each gets one, also where it does not pay.

    Returns
    -------
    Shape, float
    """
    rows = _rows(kind, times)
    shape, gain = _best_times(demands, Shape(), rows)
    left = list(found[:_MOST_NOTCHES])
    while left:
        tried = [(*_best_notch(demands, shape, rows, each), each) for each in left]
        better = max(tried, key=lambda each: each[1])
        if better[1] < _WORTH * gain and not needed:
            break
        shape, gain = better[:2]
        left.remove(better[2])
    return _refined(demands, shape, kind, times)


def _rows(kind: str, times: Array) -> Array:
    if kind == "i":
        return np.zeros((1, 3))
    if kind == "pi":
        return np.column_stack([times, np.zeros((times.size, 2))])
    pairs = [(a, b) for a, b in itertools.product(times[::2], times[::2]) if b <= 2.0 * a]
    return np.array([(Ti, Td, Td / _DERIVATIVE_FILTER) for Ti, Td in pairs])


def _best_times(
    demands: Demands, shape: Shape, rows: Array, most: int | None = _EXTREMES
) -> tuple[Shape, float]:
    responses = times_response(demands.s, rows)
    for notch in shape.notches:
        responses = responses * notch.response(demands.s, demands.dt)
    gains = demands.largest_gain(responses, most)
    k = int(np.argmax(gains))
    Ti, Td, Tf = rows[k].tolist()
    return replace(shape, Ti=Ti, Td=Td, Tf=Tf), float(gains[k])


def _best_notch(
    demands: Demands, shape: Shape, rows: Array, found: Resonance
) -> tuple[Shape, float]:
    tried = []
    depths = sorted({found.damping, max(found.damping, 0.05), max(2.0 * found.damping, 0.1)})
    for shift, zero, pole in itertools.product(_SHIFTS, depths, _POLE_DAMPINGS):
        if zero < pole:
            notch = Notch(shift * found.frequency, zero, pole)
            with_it = replace(shape, notches=(*shape.notches, notch))
            tried.append(_best_times(demands, with_it, rows))
    return max(tried, key=lambda each: each[1])


def _refined(demands: Demands, shape: Shape, kind: str, times: Array) -> tuple[Shape, float]:
    """Look between the candidates of the times, ever closer."""
    ratio = float(times[1] / times[0]) if times.size > 1 else 1.0
    best, gain = _best_times(demands, shape, np.array([[shape.Ti, shape.Td, shape.Tf]]), None)
    if kind == "i":
        return best, gain
    for step in (ratio**0.5, ratio**0.25, ratio**0.12, ratio**0.06):
        moves = step ** np.array([-1.0, 0.0, 1.0])
        rows = [
            (best.Ti * a, best.Td * b, best.Td * b / _DERIVATIVE_FILTER)
            for a, b in itertools.product(moves, moves if kind == "pid" else [1.0])
        ]
        tried = _best_times(demands, best, np.array(rows), None)
        if tried[1] > gain:
            best, gain = tried
    return best, gain

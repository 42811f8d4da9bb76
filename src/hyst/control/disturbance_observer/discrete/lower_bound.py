"""What no observer of the sampled loop can go below, of whatever order.

Any observer gives some stable ``E = 1 - Q`` that is 1 wherever Pd has a zero on or outside the
circle, and so at z = infinity: Pd answers a sample late at least. A function that is analytic
outside the circle has, by Jensen's formula, at such a point p at most the mean of ``log |E|`` over
the circle, weighted by Poisson's kernel of p. Where the stack is to stay below gamma, |E| is at
most ``e(w, gamma)``, so gamma is out of reach while the mean of log e is below 0: what is rejected
at one frequency has to be paid at others, and there are none above half the sample rate.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.discrete.stacked_gain import SampledStackedGain
from hyst.control.disturbance_observer.discrete.w_plane import from_w_plane

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_ACCURACY = 1e-4


@dataclass(frozen=True)
class LowerBound:
    """The bound's ``value``, and in words its ``reason``, with the frequency."""

    value: float
    reason: str


def sampled_lower_bound(gain: SampledStackedGain, reached: float) -> LowerBound:
    """Give a number below the stacked norm of every observer.

    Parameters
    ----------
    gain
        The problem, ready for frequencies.
    reached
        A norm that some gain reaches.
    """
    held, free = _held(gain), _at_one_frequency(gain)
    low, high = max(held.value, free.value), reached
    reason = free.reason if free.value > held.value else held.reason
    if not _payable(gain, low):
        # The plainest reason is told that is enough to refuse.
        if low < 1.0:
            reason = "what Wp rejects is paid for below half the sample rate, which Wu forbids"
        while high - low > _ACCURACY * high:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if _payable(gain, middle) else (middle, high)
    return LowerBound(min(low, reached), held.reason if held.value >= 1.0 else reason)


def _held(gain: SampledStackedGain) -> LowerBound:
    """T = 1 where the internal model has an eigenvalue on the circle, for there Q = 1."""
    poles = gain.model_poles[np.abs(gain.model_poles.real) <= 1e-9]
    places = np.maximum(np.abs(poles.imag), gain.grid.w[0])
    size, at = np.abs(gain.sampled.response(1j * places)), gain.at(places)
    values = np.sqrt(at.Wu2) / np.maximum(size, 1e-300)
    if values.size == 0:
        return LowerBound(0.0, "")
    worst = int(values.argmax())
    w = _of_time(gain, np.abs(poles.imag[worst]))
    return LowerBound(
        float(values[worst]),
        f"the internal model makes T = 1 at {w:.4g} rad/s, where Wu is {values[worst]:.4g}",
    )


def _at_one_frequency(gain: SampledStackedGain) -> LowerBound:
    """Least over complex E of both rows, the largest over frequency."""
    at, Wt2 = gain.grid, _of_T(gain)
    free = np.sqrt(Wt2 * at.Wp2 / np.maximum(Wt2 * np.abs(at.S0) ** 2 + at.Wp2, 1e-300))
    worst = int(free.argmax())
    w = _of_time(gain, at.w[worst])
    return LowerBound(
        float(free[worst]), f"Wu and Wp are both above what one frequency allows at {w:.4g} rad/s"
    )


def _payable(gain: SampledStackedGain, gamma: float) -> bool:
    """Whether the mean of log e is above 0, for each place where E has to be 1."""
    at, Wt2 = gain.grid, _of_T(gain)
    below = np.maximum(Wt2 * np.abs(at.S0) ** 2 + at.Wp2, 1e-300)
    middle = Wt2 * np.abs(at.S0) / below
    room = (gamma**2 - Wt2) / below + middle**2
    if (room < 0.0).any():
        return False
    most = np.log(np.maximum(middle + np.sqrt(room), 1e-300))
    angle = 2.0 * np.arctan(at.w)
    zeros = gain.sampled.zeros
    outside = from_w_plane(zeros[(zeros.real > 1e-9) & (np.abs(zeros - 1.0) > 1e-6)])
    places = [np.ones_like(angle)]
    for z in outside[np.abs(outside) > 1.0 + 1e-6]:
        both = np.abs(z - np.exp(1j * angle)) ** -2.0 + np.abs(z - np.exp(-1j * angle)) ** -2.0
        places.append(0.5 * (np.abs(z) ** 2 - 1.0) * both)
    # Of trapezoids a little is left to their error; below the grid e may be large, but is narrow.
    return all(
        float(np.trapezoid(kernel * most, angle)) > -_slack(kernel, most, angle)
        for kernel in places
    )


def _slack(kernel: Array, most: Array, angle: Array) -> float:
    """Allow for the ends that the grid leaves out, and for the error of the trapezoids."""
    ends = kernel[0] * abs(most[0]) * angle[0] + kernel[-1] * abs(most[-1]) * (np.pi - angle[-1])
    coarse = np.trapezoid((kernel * most)[::2], angle[::2])
    return float(2.0 * ends + abs(np.trapezoid(kernel * most, angle) - coarse))


def _of_T(gain: SampledStackedGain) -> Array:
    """Give the square of the weight of T: of K S over that of Pd."""
    at = gain.grid
    return np.asarray(at.Wu2 / np.maximum(np.abs(gain.sampled.response(1j * at.w)) ** 2, 1e-300))


def _of_time(gain: SampledStackedGain, w: float) -> float:
    """From the w-plane to rad/s."""
    return float(2.0 * np.arctan(w) / gain.problem.dt)

"""The gain of least noise among those that are as good.

The least norm is often reached by many gains, or all but reached: a weight that is constant at high
frequencies is its floor, wherever the poles are beyond. Of these gains the one is taken that makes
least of the sensor's noise, ``sup |Q / Pn|``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.minimax import Descent
from hyst.control.disturbance_observer.peaks import Curve
from hyst.control.disturbance_observer.within_limit import least_within

Array = NDArray[np.float64]

SAME = 1e-4  # of the norm: what is nearer is the same, in all digits that are told
_WORTH = 0.5  # of the noise: who gives up more than that of the norm wants this at least
_BEYOND = 3.0  # times what may be given up: from there a good start comes back


class NoisyCurve(Curve, Protocol):
    """A stacked gain that also knows its ``noise``, the square of |Q / Pn|."""

    @property
    def noise(self) -> Curve:
        """The noise gain, for the same parameters."""


def quietest(
    gain: NoisyCurve, best: Descent, starts: Sequence[Array] = (), flat: float = 0.01
) -> Descent:
    """Give the quietest of the gains whose norm is all but the best.

    The norm grows by no more than 1e-4 of itself, or by ``flat`` if that at least halves the noise
    gain; never past 1, and not by ``flat`` where it is above 1.

    Parameters
    ----------
    gain
        The stacked gain.
    best
        Of least norm.
    starts
        More parameters to start from.
    flat
        Share of the norm that may be given up; 0 leaves the best as it is.
    """
    if flat == 0.0:
        return best
    same = _kept(best.norm, min(SAME, flat))
    near = [best.parameters]
    evaluations = best.evaluations
    candidates: list[tuple[float, float, Array]] = [(best.norm, noise_of(gain, best), near[0])]

    def descended(limit: float, given: Sequence[Array]) -> Array | None:
        nonlocal evaluations
        found = [least_within(gain.noise, gain, limit, each) for each in given]
        evaluations += sum(each.evaluations for each in found)
        least = min(found, key=lambda each: each.norm)
        if not np.isfinite(least.norm):
            return None
        candidates.append((limit, least.norm, least.parameters))
        return least.parameters

    if best.norm < 1.0 and flat > SAME:
        near += [*starts]
        beyond = descended((1.0 + _BEYOND * flat) * best.norm, near)
        near += [] if beyond is None else [beyond]
        close = descended(_kept(best.norm, flat), near)
        near = [best.parameters] + ([] if close is None else [close])
    descended(same, near)
    quiet = min((each for each in candidates if each[0] <= same), key=lambda each: each[1])
    within = [each for each in candidates if each[0] <= _kept(best.norm, flat)]
    quieter = min(within, key=lambda each: each[1])
    chosen = quieter if quieter[1] <= _WORTH * quiet[1] else quiet
    norm = float(np.sqrt(gain.values(chosen[2], gain.at(gain.peaks(chosen[2]))).max()))
    return Descent(chosen[2], norm, evaluations)


def noise_of(gain: NoisyCurve, found: Descent) -> float:
    """Noise gain sup |Q / Pn| of what a descent on gain found."""
    x, noise = found.parameters, gain.noise
    return float(np.sqrt(noise.values(x, noise.at(noise.peaks(x))).max()))


def _kept(norm: float, share: float) -> float:
    """Give the norm that may be reached: not past 1 from below."""
    more = (1.0 + share) * norm
    return more if norm >= 1.0 else min(more, 1.0 - 1e-6) if norm < 1.0 - 1e-6 else norm

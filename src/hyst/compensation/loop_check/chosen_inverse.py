"""The inverse of the dynamics that a loop is seen through: of all frequencies, or of a band."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from hyst.errors import InputError, NotInvertibleError
from hyst.models import LinearDynamics, StableInverse

TOLERANCE = 1e-9
"""Share of all taps that may be left out."""

TOLERANCE_IN_BAND = 1e-5
"""The same of a band, whose edge rings for long: the model is seen through the same taps."""

SHORTER = (1e-4, 1e-3)
"""The same for short records."""

NOISY = 0.02
"""Of the range of v: a noise band wider than this, and the inverse is limited to a band."""

LONG = 0.4
"""Of the record: a longer inverse is limited to a band as well."""

HARMONICS_KEPT = 5.0
"""Times the frequency of the drive, which a band that was not asked for never cuts."""

_NEAR_THE_CIRCLE = 1e-2
_LOWEST_ZERO = 0.02  # of the sample rate
_BELOW_THE_ZERO = 0.7
_STEP = 0.8


@dataclass(frozen=True, eq=False)
class ChosenInverse:
    """An inverse, up to which frequency it is one, and why.

    Parameters
    ----------
    inverse
        The two-sided inverse.
    band
        Highest frequency that is inverted, Hz; None for all.
    note
        Why there is a band that nobody asked for; else empty.
    """

    inverse: StableInverse
    band: float | None
    note: str = ""


class Inverses:
    """Inverses of dynamics up to several frequencies, each expanded once.

    Parameters
    ----------
    dynamics
        What is inverted.
    """

    def __init__(self, dynamics: LinearDynamics) -> None:
        self.dynamics = dynamics
        self._known: dict[float, StableInverse] = {}

    def below(self, limit: float) -> StableInverse:
        """Give the inverse of a band, Hz; of all frequencies for infinity."""
        if limit not in self._known:
            band = None if limit == math.inf else limit
            tolerance = TOLERANCE if band is None else TOLERANCE_IN_BAND
            self._known[limit] = StableInverse.of(self.dynamics, tolerance=tolerance, band=band)
        return self._known[limit]


def inverse_for_loop(
    inverses: Inverses,
    band: float | None,
    noise: float,
    extent: float,
    highest: float,
    samples: int,
) -> ChosenInverse:
    """Give the inverse for a record: of all frequencies, unless zeros, noise or length forbid it.

    The dynamics of an actuator let little of the highest frequencies through, so their inverse
    makes the noise there large and rings for long, and none of the loop lies there.

    Parameters
    ----------
    inverses
        Of the dynamics.
    band
        Highest frequency to invert, Hz, which is kept; None for as high as may be.
    noise
        Standard deviation of the noise of the output.
    extent
        Range of the signal behind the hysteresis.
    highest
        Frequency of the drive, Hz, the highest there is; 0 where it does not repeat: then only a
        zero limits the band.
    samples
        Of the record.

    Raises
    ------
    InputError
        If the band is beyond half the sample rate.
    NotInvertibleError
        If a zero on or next to the unit circle lies within the band, or so low that no band is
        left; if the dynamics are not stable.
    """
    dt = inverses.dynamics.dt
    if band is not None:
        if band >= 0.5 / dt:
            raise InputError(
                f"band is {band:.6g} Hz, and records of {1.0 / dt:.6g} samples a second hold "
                f"nothing above {0.5 / dt:.6g} Hz; give a lower one, or none"
            )
        return ChosenInverse(_in_band(inverses, band, samples), band)
    first = found = _widest(inverses, samples)
    limit = _STEP * (0.5 / dt if first.band is None else first.band)
    while limit >= HARMONICS_KEPT * highest > 0.0:
        short = _is_short(found.inverse, samples)
        if short and 2.0 * noise * found.inverse.noise_gain <= NOISY * extent:
            break
        inverse = _in_band(inverses, limit, samples)
        if _is_short(inverse, samples) or inverse.h.size < found.inverse.h.size:
            found = ChosenInverse(inverse, limit, _why(first, limit, noise))
        elif found is not first:
            break  # the narrower the band, the longer the inverse, but for zeros at its edge
        limit *= _STEP
    return found


def _widest(inverses: Inverses, samples: int) -> ChosenInverse:
    try:
        return ChosenInverse(inverses.below(math.inf), None)
    except NotInvertibleError:
        dynamics = inverses.dynamics
        zeros = dynamics.zeros()
        near = zeros[np.abs(np.abs(zeros) - 1.0) < _NEAR_THE_CIRCLE]
        lowest = float(np.abs(np.angle(near)).min(initial=np.pi)) / (2.0 * np.pi * dynamics.dt)
        if not dynamics.is_stable() or not near.size or lowest <= _LOWEST_ZERO / dynamics.dt:
            raise
        limit = _BELOW_THE_ZERO * lowest
        note = (
            f"seen below {limit:.4g} Hz, for a zero of the dynamics lies next to the unit circle "
            f"at {lowest:.4g} Hz"
        )
        return ChosenInverse(_in_band(inverses, limit, samples), limit, note)


def _in_band(inverses: Inverses, limit: float, samples: int) -> StableInverse:
    inverse = inverses.below(limit)
    for tolerance in SHORTER:
        if _is_short(inverse, samples):
            break
        inverse = _shortened(inverses.below(limit), tolerance)
    return inverse


def _shortened(inverse: StableInverse, tolerance: float) -> StableInverse:
    """Leave out taps at both ends that sum up to no more than a share of all."""
    size = np.abs(inverse.h)
    spare = 0.5 * tolerance * float(size.sum())
    first = int(np.argmax(np.cumsum(size) > spare))
    last = size.size - int(np.argmax(np.cumsum(size[::-1]) > spare))
    first, last = min(first, inverse.preview), max(last, inverse.preview + 1)
    return replace(inverse, h=inverse.h[first:last].copy(), preview=inverse.preview - first)


def _is_short(inverse: StableInverse, samples: int) -> bool:
    return inverse.h.size <= LONG * samples


def _why(first: ChosenInverse, limit: float, noise: float) -> str:
    before = "all frequencies" if first.band is None else f"all below {first.band:.4g} Hz"
    return (
        f"seen below {limit:.4g} Hz, where the harmonics lie: the inverse of {before} would blur "
        f"the loop by +- {2.0 * noise * first.inverse.noise_gain:.3g} and lose "
        f"{first.inverse.h.size - 1} samples at the ends"
    )

"""The inverse of the dynamics that loops are seen through: of all frequencies, or of a band."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hyst.checks.numbers import as_positive
from hyst.errors import InputError, NotInvertibleError
from hyst.models import LinearDynamics, StableInverse

TOLERANCE = 1e-9
"""Share of all taps that may be left out."""

TOLERANCE_IN_BAND = 1e-5
"""The same of a band: a sharper edge rings for longer, and the model is seen through it, too."""

NOISY = 0.02
"""Of the range of v: a noise band wider than this, and the inverse is limited to a band."""

LONG = 0.4
"""Of the shortest record: a longer inverse is limited to a band as well."""

HARMONICS_KEPT = 5.0
"""Times the highest frequency of a drive, which a band that was not asked for never cuts."""

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
        Why there is a band; empty where nothing is to be said.
    """

    inverse: StableInverse
    band: float | None
    note: str = ""


def inverse_for_loops(dynamics: LinearDynamics, band: float | None) -> ChosenInverse:
    """Give the stable inverse, of a band only where it is asked for or a zero forbids more.

    Parameters
    ----------
    dynamics
        Stable.
    band
        Highest frequency to invert, Hz; None for as high as the zeros allow.

    Raises
    ------
    NotInvertibleError
        If a zero on or next to the unit circle lies within the band, or so low that no band is
        left; if the dynamics are not stable.
    """
    if band is not None:
        limit = as_positive(band, "band", "a frequency in Hz")
        if limit >= 0.5 / dynamics.dt:
            raise InputError(
                f"band is {limit:.6g} Hz, and records of {1.0 / dynamics.dt:.6g} samples a second "
                f"hold nothing above {0.5 / dynamics.dt:.6g} Hz; give a lower one, or none"
            )
        return ChosenInverse(
            StableInverse.of(dynamics, tolerance=TOLERANCE_IN_BAND, band=limit), limit
        )
    try:
        return ChosenInverse(StableInverse.of(dynamics, tolerance=TOLERANCE), None)
    except NotInvertibleError:
        zeros = dynamics.zeros()
        near = zeros[np.abs(np.abs(zeros) - 1.0) < _NEAR_THE_CIRCLE]
        lowest = float(np.abs(np.angle(near)).min(initial=np.pi)) / (2.0 * np.pi * dynamics.dt)
        if not dynamics.is_stable() or not near.size or lowest <= _LOWEST_ZERO / dynamics.dt:
            raise
        limit = _BELOW_THE_ZERO * lowest
        inverse = StableInverse.of(dynamics, tolerance=TOLERANCE_IN_BAND, band=limit)
        return ChosenInverse(
            inverse,
            limit,
            f"a zero of the dynamics lies next to the unit circle at {lowest:.4g} Hz, so the loops "
            f"are seen below {limit:.4g} Hz only",
        )


def adapted(
    chosen: ChosenInverse,
    dynamics: LinearDynamics,
    noise: float,
    extent: float,
    highest: float,
    samples: int,
) -> ChosenInverse:
    """Limit an inverse to a band where it would drown the loop in noise, or outlast the record.

    The dynamics of an actuator let little of the highest frequencies through, so their inverse
    makes the noise there large and rings for long, and none of the loop lies there.

    Parameters
    ----------
    chosen
        The inverse to begin with.
    dynamics
        What it inverts.
    noise
        Standard deviation of the noise of the output.
    extent
        Range of the signal behind the hysteresis.
    highest
        Highest frequency of a drive, Hz; 0 where there is none, and nothing is limited then.
    samples
        Of the shortest record.
    """
    limit = chosen.band if chosen.band is not None else 0.5 / dynamics.dt
    found = chosen
    while highest > 0.0 and _STEP * limit >= HARMONICS_KEPT * highest:
        blur = 2.0 * noise * found.inverse.noise_gain
        fits = found.inverse.h.size <= LONG * samples
        if blur <= NOISY * extent and fits:
            break
        limit *= _STEP
        inverse = StableInverse.of(dynamics, tolerance=TOLERANCE_IN_BAND, band=limit)
        if fits and inverse.h.size > LONG * samples:
            break  # the narrower the band, the longer the inverse
        found = ChosenInverse(inverse, limit, _why(chosen, limit, noise))
    return found


def _why(chosen: ChosenInverse, limit: float, noise: float) -> str:
    first = chosen.inverse
    return (
        f"seen below {limit:.4g} Hz, where the harmonics lie: the inverse of all frequencies would "
        f"blur the loop by +- {2.0 * noise * first.noise_gain:.3g} and lose {first.h.size - 1} "
        "samples at the ends"
    )

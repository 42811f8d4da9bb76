"""Swept sine: one frequency after the other."""

from __future__ import annotations

import math

import numpy as np

from hyst.checks.numbers import as_positive, as_sample_time
from hyst.errors import InputError
from hyst.signals.drive import Drive, Limits, as_count, fitted, require_length


def swept_sine(
    dt: float,
    samples: int,
    band: tuple[float, float],
    amplitude: float,
    *,
    spacing: str = "linear",
    periods: int = 1,
    offset: float = 0.0,
    max_rate: float = math.inf,
    max_acceleration: float = math.inf,
) -> Drive:
    """Make a sine whose frequency goes from one end of a band to the other.

        u(t) = offset + amplitude sin(2 pi phase(t))

    Parameters
    ----------
    dt
        Sample time, s.
    samples
        Samples of one sweep.
    band
        First and last frequency, Hz, below half the sample rate.
    amplitude
        Of the sine, input units.
    spacing
        ``"linear"`` in time, or ``"logarithmic"``: as long in each octave.
    periods
        Number of sweeps.
    offset
        Mean, input units.
    max_rate, max_acceleration
        Limits, as of ``Limits``; the signal is scaled down to meet them.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If the band is not within 0 and half the sample rate, or an argument cannot be used.

    Examples
    --------
    >>> swept_sine(1e-3, 2000, (1.0, 50.0), 5.0).period
    2000
    """
    time, count = as_sample_time(dt), as_count(samples, "samples", 4)
    require_length(count * as_count(periods, "periods"))
    first, last = as_positive(band[0], "band[0]"), as_positive(band[1], "band[1]")
    if max(first, last) >= 0.5 / time:
        raise InputError(
            f"band ends at {max(first, last):.6g} Hz; stay below half the sample rate, "
            f"{0.5 / time:.6g} Hz"
        )
    x = np.arange(count) / count
    if spacing == "linear":
        phase = first * x + 0.5 * (last - first) * x**2
    elif spacing == "logarithmic":
        ratio = math.log(last / first)
        phase = first * np.expm1(ratio * x) / ratio if ratio else first * x
    else:
        raise InputError(f"spacing is {spacing!r}; choose 'linear' or 'logarithmic'")
    # A whole number of turns, so that one sweep joins the next.
    total = 0.5 * (first + last) if spacing == "linear" else _mean_frequency(first, last)
    duration = max(round(total * count * time), 1) / total
    sweep = as_positive(amplitude, "amplitude") * np.sin(2.0 * np.pi * duration * phase)
    sweep, notes = fitted(sweep, time, Limits(max_rate, max_acceleration), offset)
    u = np.tile(sweep, periods) + offset
    return Drive(u, time, "swept-sine", count, notes)


def _mean_frequency(first: float, last: float) -> float:
    ratio = math.log(last / first)
    return (last - first) / ratio if ratio else first

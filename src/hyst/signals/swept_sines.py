"""Swept sine: one frequency after the other."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_positive, as_sample_time
from hyst.errors import InputError
from hyst.signals.drive import Drive, Limits, as_count, fitted, require_length
from hyst.signals.limited_sweep import limited_sweep
from hyst.signals.periodic_drive import require_kept

Array = NDArray[np.float64]

SPACINGS = ("linear", "logarithmic")


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
    keep: str = "amplitude",
) -> Drive:
    """Make a sine whose frequency goes from one end of a band to the other.

        u(t) = offset + a(f(t)) sin(2 pi phase(t)),  phase' = f

    Within limits the amplitude is ``min(amplitude, max_rate / (2 pi f), max_acceleration / (2 pi
    f)^2)``: as asked for where the limits allow it.

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
        Limits, as of ``Limits``.
    keep
        What limits leave alone: ``"amplitude"``, and only frequencies too fast for it have less; or
        ``"spectrum"``, and all is scaled down.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If the band is not within 0 and half the sample rate, the amplitude is too much for the
        limits at its lowest frequency, or an argument cannot be used.

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
    require_kept(keep)
    half, middle = as_positive(amplitude, "amplitude"), as_number(offset, "offset")
    phase, frequency = _swept(first, last, count, time, spacing)
    limits = Limits(max_rate, max_acceleration)
    if keep == "spectrum":
        sweep, notes = fitted(half * np.sin(2.0 * np.pi * phase), time, limits, middle)
    else:
        sweep, notes = limited_sweep(half, phase, frequency, time, limits, middle)
    return Drive(np.tile(sweep, periods) + middle, time, "swept-sine", count, notes)


def _swept(first: float, last: float, count: int, dt: float, spacing: str) -> tuple[Array, Array]:
    """Give phase in turns and frequency in Hz, with a whole number of turns."""
    x = np.arange(count) / count
    if spacing == "linear":
        phase, frequency = first * x + 0.5 * (last - first) * x**2, first + (last - first) * x
        mean = 0.5 * (first + last)
    elif spacing == "logarithmic":
        ratio = math.log(last / first)
        phase = first * np.expm1(ratio * x) / ratio if ratio else first * x
        frequency = first * np.exp(ratio * x)
        mean = (last - first) / ratio if ratio else first
    else:
        raise InputError(f"spacing is {spacing!r}; choose one of {', '.join(SPACINGS)}")
    # A whole number of turns, so that one sweep joins the next.
    duration = max(round(mean * count * dt), 1) / mean
    return duration * phase, duration / (count * dt) * frequency

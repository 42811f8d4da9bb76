"""Noise through a low pass, exactly periodic."""

from __future__ import annotations

import math

import numpy as np

from hyst.checks.numbers import as_positive, as_sample_time, whole_number
from hyst.errors import InputError
from hyst.signals.drive import Drive, Limits, as_count, require_length
from hyst.signals.limited_lines import Lines
from hyst.signals.periodic_drive import factor_of, period_of


def lowpassed_noise(
    dt: float,
    samples: int,
    corner: float,
    *,
    amplitude: float | None = None,
    rms: float | None = None,
    order: int = 4,
    uniform: bool = False,
    periods: int = 1,
    offset: float = 0.0,
    max_rate: float = math.inf,
    max_acceleration: float = math.inf,
    keep: str = "amplitude",
    seed: int = 0,
) -> Drive:
    """Make Gaussian noise with the power ``1 / (1 + (f / corner)^(2 order))`` over frequency.

    Parameters
    ----------
    dt
        Sample time, s.
    samples
        N, samples of one period.
    corner
        Of the low pass, Hz, below half the sample rate.
    amplitude
        Largest deviation from the offset, input units. Give it or ``rms``.
    rms
        Root mean square deviation from the offset.
    order
        Of the low pass (Butterworth), 1 to 20.
    uniform, periods, offset, max_rate, max_acceleration, keep
        As of ``multisine``.
    seed
        Of the noise; equal seeds give equal signals.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If the corner is not below half the sample rate, or as ``multisine``.

    Examples
    --------
    >>> drive = lowpassed_noise(1e-3, 2000, 50.0, amplitude=2.0)
    >>> drive.period, round(float(abs(drive.u).max()), 9)
    (2000, 2.0)
    """
    time, count = as_sample_time(dt), as_count(samples, "samples", 4)
    require_length(count * as_count(periods, "periods"))
    cut = as_positive(corner, "corner", "Hz")
    if cut >= 0.5 / time:
        raise InputError(
            f"corner is {cut:.6g} Hz; stay below half the sample rate, {0.5 / time:.6g} Hz"
        )
    steepness = whole_number(order, "order", 1, 20)
    rng = np.random.default_rng(seed)
    numbers = np.arange(1, (count - 1) // 2 + 1)
    frequency = numbers / (count * time)
    passed = 1.0 / np.sqrt(1.0 + (frequency / cut) ** (2 * steepness))
    # Noise has sizes by chance, too; a multisine has not.
    sizes = passed * rng.rayleigh(size=numbers.size)
    phases = rng.uniform(0.0, 2.0 * np.pi, numbers.size)
    lines = Lines(
        numbers, sizes, count, time, lambda period: factor_of(period, amplitude, rms), offset
    )
    period, notes = period_of(lines, phases, Limits(max_rate, max_acceleration), keep, uniform)
    return Drive(np.tile(period, periods) + offset, time, "noise", count, notes)

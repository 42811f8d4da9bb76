"""Linear dynamics by what a data sheet says: a resonance, a low-pass."""

from __future__ import annotations

import math

from hyst.checks.numbers import as_positive, whole_number
from hyst.errors import InputError
from hyst.models.linear_dynamics import LinearDynamics


def resonance(
    frequency: float, damping: float, dt: float, gain: float = 1.0, delay: int = 0
) -> LinearDynamics:
    """Make ``gain w^2 / (s^2 + 2 damping w s + w^2)``, w = 2 pi frequency, its input held.

    Parameters
    ----------
    frequency
        Natural frequency, Hz, below half the sample rate.
    damping
        Share of the critical damping, > 0; a mode of a metal part has some 0.01, an amplifier 0.7.
    dt
        Sample time, s.
    gain
        At rest, output units per input unit.
    delay
        Whole samples.

    Returns
    -------
    LinearDynamics

    Raises
    ------
    InputError
        If the frequency is not between 0 and half the sample rate, or the damping not above 0.

    Examples
    --------
    >>> stage = resonance(200.0, 0.03, dt=1e-4)
    >>> float(abs(stage.frequency_response(200.0)[0]).round(1)), round(stage.dc_gain(), 9)
    (16.7, 1.0)
    """
    w = _angular(frequency, dt)
    share = as_positive(damping, "damping", "a share of the critical damping")
    return LinearDynamics.from_continuous([gain * w * w], [1.0, 2.0 * share * w, w * w], dt, delay)


def low_pass(
    frequency: float, dt: float, order: int = 1, gain: float = 1.0, delay: int = 0
) -> LinearDynamics:
    """Make a low-pass, as an amplifier is: a first-order lag, or a Butterworth filter, input held.

    Parameters
    ----------
    frequency
        Where the gain has fallen to 0.71 of that at rest, Hz, below half the sample rate.
    dt
        Sample time, s.
    order
        1 or 2.
    gain
        At rest, output units per input unit.
    delay
        Whole samples.

    Returns
    -------
    LinearDynamics

    Raises
    ------
    InputError
        If the frequency is not between 0 and half the sample rate, or the order not 1 or 2.

    Examples
    --------
    >>> amplifier = low_pass(500.0, dt=1e-5)
    >>> float(abs(amplifier.frequency_response(500.0)[0]).round(3))
    0.707
    """
    w = _angular(frequency, dt)
    if whole_number(order, "order", 1, 2) == 2:
        return resonance(frequency, math.sqrt(0.5), dt, gain, delay)
    return LinearDynamics.from_continuous([gain * w], [1.0, w], dt, delay)


def _angular(frequency: float, dt: float) -> float:
    own = as_positive(frequency, "frequency", "a frequency in Hz")
    time = as_positive(dt, "dt", "a sample time in seconds")
    if 2.0 * own * time >= 1.0:
        raise InputError(
            f"frequency is {own:.6g} Hz, not below half the sample rate, {0.5 / time:.6g} Hz; "
            "give a lower frequency or a shorter dt"
        )
    return 2.0 * math.pi * own

"""A sine that is swept, as large as limits allow at each of its frequencies."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.signals.drive import Limits, steps_of

Array = NDArray[np.float64]

_TRIES = 20
_SHORTEST_FADE = 8  # samples
_KEPT = 0.95  # of the amplitude: less is not kept
_SHARP = 8.0


def limited_sweep(
    amplitude: float, phase: Array, frequency: Array, dt: float, limits: Limits, offset: float
) -> tuple[Array, tuple[str, ...]]:
    """Make a swept sine whose amplitude falls where limits ask for it, and nowhere else.

    Parameters
    ----------
    amplitude
        Wanted, input units.
    phase, frequency
        Shape (N,), turns and Hz; the phase ends after whole turns.
    dt
        Sample time, s.
    limits
        Limits.
    offset
        What will be added, for rounding.

    Returns
    -------
    numpy.ndarray
        Shape (N,), without offset.
    tuple of str
        From which frequency on the amplitude falls, and where the ends fade.

    Raises
    ------
    InputError
        If the lowest frequency has the amplitude taken away already, the sweep is past it before
        it has the amplitude, or the ends would have to fade for a quarter of the sweep.
    """
    wave = np.sin(2.0 * np.pi * phase)
    if math.isinf(limits.max_rate) and math.isinf(limits.max_acceleration):
        return amplitude * wave, ()
    largest = amplitude + abs(offset)
    step, bend = limits.step(dt, largest), limits.bend(dt, largest)
    as_wanted = steps_of(amplitude * wave)
    if as_wanted[0] <= step and as_wanted[1] <= bend:
        return amplitude * wave, ()
    _require_possible(amplitude, float(frequency.min()), dt, limits)
    envelope = _envelope(amplitude, wave, frequency * dt, step, bend)
    u, faded = _joined(envelope * wave, step, bend)
    reached = float(np.abs(u).max())
    if reached < _KEPT * amplitude:
        raise InputError(
            f"the sweep reaches only {reached:.3g} of the amplitude {amplitude:.4g}, for it passes "
            "the frequencies for which the limits allow that too quickly; give a longer duration, "
            "logarithmic spacing, a lower first frequency or a lower amplitude"
        )
    notes = []
    falls = frequency[envelope < _KEPT * amplitude]
    if falls.size:
        notes.append(
            f"the amplitude is kept up to {falls.min():.4g} Hz and falls above it, to "
            f"{100.0 * float(envelope.min()) / amplitude:.3g} % at {frequency.max():.4g} Hz, to "
            "obey the limits"
        )
    if faded:
        notes.append(f"the first and last {faded} samples fade, so that sweeps join in the limits")
    return u, tuple(notes)


def _require_possible(amplitude: float, lowest: float, dt: float, limits: Limits) -> None:
    chord = 2.0 * math.sin(math.pi * lowest * dt)  # of a sampled sine, from sample to sample
    for name, allowed, needs in (
        ("max_rate", limits.max_rate, amplitude * chord / dt),
        ("max_acceleration", limits.max_acceleration, amplitude * (chord / dt) ** 2),
    ):
        if needs > allowed:
            raise InputError(
                f"{name} is {allowed:.6g}, but a sine of amplitude {amplitude:.4g} at "
                f"{lowest:.4g} Hz, the lowest of the band, needs {needs:.4g}; lower the amplitude "
                f"to {amplitude * allowed / needs:.3g}, or begin the band lower"
            )


def _envelope(amplitude: float, wave: Array, turns: Array, step: float, bend: float) -> Array:
    """Give the amplitude of every sample; a change of it takes its part of the limits."""
    chord = 2.0 * np.sin(np.pi * turns)
    for_rate = for_bend = 1.0
    for _ in range(_TRIES):
        # A smooth minimum, for a bend of the envelope is an acceleration.
        by_rate = amplitude * chord / (for_rate * step)
        by_bend = amplitude * chord**2 / (for_bend * bend)
        envelope = amplitude * (1.0 + by_rate**_SHARP + by_bend**_SHARP) ** (-1.0 / _SHARP)
        u = envelope * wave
        rate = float(np.abs(np.diff(u)).max(initial=0.0)) / step
        turn = float(np.abs(np.diff(u, 2)).max(initial=0.0)) / bend
        if max(rate, turn) <= 1.0:
            break
        for_rate /= max(rate, 1.0) * (1.0 + 1e-9)
        for_bend /= max(turn, 1.0) * (1.0 + 1e-9)
    return np.asarray(envelope)


def _joined(u: Array, step: float, bend: float) -> tuple[Array, int]:
    """Fade both ends as long as it takes for the end to join the beginning."""
    faded, length = u, 0
    while True:
        rate, turn = steps_of(faded)
        if rate <= step and turn <= bend:
            return faded, length
        length = 2 * length if length else _SHORTEST_FADE
        if length > u.size // 4:
            raise InputError(
                "the ends of the sweep would have to fade for more than a quarter of it to join "
                "within the limits; give a longer duration, a lower amplitude or a narrower band"
            )
        rise = np.sin(0.5 * np.pi * np.arange(length) / length) ** 2
        faded = u.copy()
        faded[:length] *= rise
        faded[u.size - length :] *= rise[::-1]

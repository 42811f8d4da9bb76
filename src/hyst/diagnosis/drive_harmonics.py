"""Lines that a drive puts into the output by way of its loop, though the drive has none there."""

from __future__ import annotations

from collections.abc import Sequence

from hyst.diagnosis.spectral_lines import Line

# A loop bends at every turn, so its harmonics fall with the square of their order at the least.
_SHARE_OF_SPAN = 0.5
_SHARE_OF_TONE = 0.2  # of one tone, that a loop run by another one modulates
_MOST_ORDERS = 10
_RESOLUTION = 1.5  # over the duration


def is_folded_harmonic(line: Line, period: float, dt: float, span: float, samples: int) -> bool:
    """Tell whether a line lies where a harmonic above half the sample rate is folded to.

    Of few samples a period such harmonics are large, and a period that is no whole number of
    samples folds them to between the others.

    Parameters
    ----------
    line
        The line.
    period
        Of the drive, samples.
    dt
        Time between samples, s.
    span
        Range of the output: what a harmonic can be is a share of it.
    samples
        Of the record, which set how near is the same.
    """
    place = line.frequency * dt
    order = max(int(period / 2.0), 1)
    while line.amplitude <= _SHARE_OF_SPAN * span / order**2:
        folded = abs(order / period - round(order / period))
        if abs(folded - place) < _RESOLUTION / samples and order / period > 0.5:
            return True
        order += 1
    return False


def is_between_tones(line: Line, tones: Sequence[Line], base: float, duration: float) -> bool:
    """Tell whether a line is one tone of the drive, moved by a few times the base frequency.

    Parameters
    ----------
    line
        The line.
    tones
        Tones of the drive that are no harmonics of its base, amplitudes in units of the output.
    base
        Frequency of the drive, Hz.
    duration
        Of the record, s.
    """
    for tone in tones:
        if line.amplitude > _SHARE_OF_TONE * tone.amplitude:
            continue
        for apart in (abs(line.frequency - tone.frequency), line.frequency + tone.frequency):
            order = round(apart / base)
            near = abs(apart - order * base) < _RESOLUTION / duration
            if near and 1 <= order <= _MOST_ORDERS:
                return True
    return False

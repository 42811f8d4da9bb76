"""A sine that is not the drive's, as the hum of the mains."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.remainder import Part, Remainder
from hyst.identification.judgement.spectral_lines import lines_of, longest_part

Array = NDArray[np.float64]

MAINS = (50.0, 60.0)
NEAR_MAINS = 0.004
"""Share by which the frequency of the mains and clocks of converters are off."""

MOST_RECORDS = 10


def _columns(remainder: Remainder) -> Array:
    """Give cosine and sine of every line, of every record by itself."""
    lines, count = lines_of(remainder), len(remainder.parts)
    if not lines or count > MOST_RECORDS:
        return np.empty((remainder.rows.size, 0))

    def of_part(part: Part) -> Array:
        columns = np.zeros((part.rows.size, count, len(lines), 2))
        phase = 2.0 * np.pi * np.outer(part.time[part.rows], lines)
        columns[:, remainder.parts.index(part)] = np.stack([np.cos(phase), np.sin(phase)], axis=-1)
        return columns.reshape(part.rows.size, -1)

    return remainder.columns(of_part)


def _sentence(found: Contribution) -> str:
    remainder, lines = found.remainder, lines_of(found.remainder)
    at = remainder.parts.index(longest_part(remainder))
    pairs = found.coefficients.reshape(len(remainder.parts), len(lines), 2)[at]
    told = [
        f"a sine of {line:.5g} Hz{_origin(line)} and amplitude "
        f"{remainder.said(float(np.hypot(*pair)))}"
        for line, pair in zip(lines, pairs, strict=True)
    ]
    return f"On the output there is {' and '.join(told)}, which is not the drive's."


def _origin(frequency: float) -> str:
    for mains in MAINS:
        order = round(frequency / mains)
        if 1 <= order <= 10 and abs(frequency - order * mains) <= NEAR_MAINS * order * mains:
            return " (the mains)"
    return ""


SINE = Cause(
    "sine",
    _columns,
    _sentence,
    "A sine on the sensor is pick-up or vibration and none of the model: shield the cable, or "
    "choose a drive frequency of which the line is no multiple. Lines about one frequency that are "
    "multiples of the drive's may be a resonance: --family hammerstein.",
    disturbs=True,
)

"""The loop is another one when it is run faster."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import branch_frequencies, frequency_of, octaves_of
from hyst.identification.judgement.general_loops import loops_of_part
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

FEWEST_OCTAVES = 0.5
"""Between frequencies of branches: with less, rate and shape of the loop are not told apart."""


def _columns(remainder: Remainder) -> Array:
    if octaves_of(remainder.parts) < FEWEST_OCTAVES:
        return np.empty((remainder.rows.size, 0))
    octaves = np.concatenate([np.log2(branch_frequencies(each)) for each in remainder.parts])
    middle = float(octaves.mean())

    def of_part(part: Part) -> Array:
        # Loops whose weights change with the logarithm of the frequency.
        relative = np.log2(branch_frequencies(part)[part.rows]) - middle
        loops = loops_of_part(remainder, part)
        speed = np.gradient(part.u) / part.dt if part.u.size > 2 else np.zeros(part.u.size)
        speed = speed / (np.abs(speed).max(initial=0.0) or 1.0)
        speed = speed[part.rows]
        root = np.sign(speed) * np.sqrt(np.abs(speed))
        return np.column_stack([relative[:, None] * loops, speed, root])

    return remainder.columns(of_part)


def _sentence(found: Contribution) -> str:
    return (
        "The loop depends on the rate at which it is run, which makes "
        f"{found.size} rms of what is left.{_by_frequency(found.remainder)}"
    )


def _by_frequency(remainder: Remainder) -> str:
    """Tell the errors of the slowest and the fastest record, where there are several."""
    if len(remainder.parts) < 2:
        return ""
    told = [
        f"{remainder.plain(float(np.sqrt(np.mean(each.error**2))))} rms at "
        f"{frequency_of(each):.3g} Hz"
        for each in sorted(remainder.parts, key=frequency_of)
    ]
    return f" The model misses by {told[0]} and by {told[-1]}."


RATE = Cause(
    "rate",
    _columns,
    _sentence,
    "Use a model that depends on the rate (--family rdpi, or hammerstein where there is a "
    "resonance), or identify at the rate at which the actuator will work.",
    beyond_loops=True,
)

"""An output that falls while the input rises on a large part: a butterfly."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.wording import of_record, percent

NAME = "butterfly"
# A middle line of the loop that goes back by this much of the loop's height is not monotone; a lag
# widens a loop and leaves its middle alone.
_LEAST_RETURN = 0.15


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn where one output belongs to inputs far apart, so that no model has an inverse."""
    for number, record in evidence.numbered():
        loops = evidence.loops(number)
        if not loops:
            continue
        largest = max(loops, key=lambda each: each.high - each.low)
        alike = [each for each in loops if each.like(largest)]
        middle = np.mean([each.middle - each.middle.mean() for each in alike], axis=0)
        # Three sigma: what noise alone makes of the middle.
        floor = 3.0 * evidence.noise_or_guess(number) / np.sqrt(max(largest.samples, 1.0))
        # Of a loop that is not closed the middle means little: either branch must turn back, too.
        branches = min(min(_variation(largest.up)), min(_variation(largest.down)))
        back = min(*_variation(middle), branches) - floor
        if back < _LEAST_RETURN * largest.height:
            continue
        steps = np.concatenate([np.diff(largest.up), np.diff(largest.down)])
        share = float(min(np.mean(steps < 0.0), np.mean(steps > 0.0)))
        yield Finding(
            NAME,
            "warning",
            f"{of_record(evidence, number)}the output falls while the input rises on "
            f"{percent(share)} of the loop and rises on the rest, as the strain of a material "
            "whose polarization is switched.",
            f"Only family 'butterfly' describes such a {record.output_name}: every other one needs "
            "an output that goes one way with its input. A wanted output does not determine a "
            "command; for that stay on one wing: keep the input on one side of the turning point.",
            record=number,
            amounts={"share": share, "return": back},
        )


def _variation(values: NDArray[np.float64]) -> tuple[float, float]:
    """How far a curve goes up, and how far down, where it goes furthest without coming back."""
    lowest, highest = np.minimum.accumulate(values), np.maximum.accumulate(values)
    return float((values - lowest).max()), float((highest - values).max())

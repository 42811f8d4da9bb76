"""Too few amplitudes to judge minor loops by."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.amplitudes import amplitudes_of, ranges_of
from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding

NAME = "amplitudes"


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn where all loops have one range, and where there is hardly one loop."""
    drives = [record.u for _, record in evidence.numbered()]
    # Records of different amplitudes make up for one another.
    if not drives or len(ranges_of(drives)) > 1:
        return
    turns = sum(amplitudes_of(u).turns for u in drives)
    if turns == 0:
        yield Finding(
            NAME,
            "warning",
            "the input does not turn round, so the record shows no hysteresis at all.",
            "Drive it up and down again.",
        )
        return
    which = (
        "one loop only, from where the record begins"
        if turns == 1
        else "loops of one amplitude only"
    )
    apart = " Nor can a lag and a small radius be told apart." if _of_one_rate(drives) else ""
    yield Finding(
        NAME,
        "warning",
        f"the input has {which}: what a model says of smaller loops inside is extrapolation, and "
        f"nothing in the data can confirm it.{apart}",
        "Record loops of several amplitudes, one within another.",
        amounts={"reversals": float(turns)},
    )


def _of_one_rate(drives: list[NDArray[np.float64]]) -> bool:
    """Whether every drive moves at one rate, as a triangle does."""
    for u in drives:
        steps = np.abs(np.diff(u))
        moving = steps[steps > 0.02 * float(steps.max())]
        if np.percentile(moving, 10.0) < 0.8 * np.percentile(moving, 90.0):
            return False
    return True

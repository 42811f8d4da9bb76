"""An output that falls as its input rises."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.loops import CELLS, Loop
from hyst.diagnosis.wording import amount, of_record

NAME = "sign"
# Of the height of the loop: a middle that rises or falls by less has no sign.
_LEAST_CHANGE = 0.3


def sign_of(loop: Loop) -> int:
    """Give the sign of the gain of a loop; 0 where its middle tells none."""
    change = loop.gain * (loop.high - loop.low)
    t = np.linspace(-1.0, 1.0, CELLS)
    middle = loop.middle - loop.middle.mean()
    spread = float(np.linalg.norm(middle)) * float(np.linalg.norm(t))
    if abs(change) < _LEAST_CHANGE * loop.height or abs(float(t @ middle)) < 0.7 * spread:
        return 0
    return 1 if change > 0.0 else -1


def find(evidence: Evidence) -> Iterator[Finding]:
    """Tell a negative gain, which printed constants do not show at first sight."""
    for number, record in evidence.numbered():
        loops = evidence.loops(number)
        if not loops:
            continue
        largest = max(loops, key=lambda each: each.high - each.low)
        if sign_of(largest) >= 0:
            continue
        per = record.input_unit or "unit of the input"
        yield Finding(
            NAME,
            "remark",
            f"{of_record(evidence, number)}the output falls as the input rises: the gain is "
            f"{amount(largest.gain, record.output_unit, per)}.",
            "If the sensor counts the other way, a model carries that as a negative gain; nothing "
            "needs to be done.",
            record=number,
            amounts={"gain": largest.gain},
        )

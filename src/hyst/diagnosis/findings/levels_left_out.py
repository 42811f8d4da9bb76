"""A drive that jumps over a part of its range, in which no sample says what the output does."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.wording import amount, percent

NAME = "levels left out"
_LEAST = 0.25  # of the range of the inputs


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn of a part of the range of all records together that holds no sample."""
    records = [record for _, record in evidence.numbered()]
    if not records:
        return
    levels = np.unique(np.concatenate([each.u for each in records]))
    steps = np.diff(levels)
    share = float(steps.max(initial=0.0)) / float(np.ptp(levels)) if levels.size > 1 else 0.0
    if share < _LEAST:
        return
    place = int(np.argmax(steps))
    low, high = float(levels[place]), float(levels[place + 1])
    unit = records[0].input_unit
    yield Finding(
        NAME,
        "warning",
        f"between {amount(low, '')} and {amount(high, unit)}, {percent(share)} of the input's "
        "range, there is no sample: what a model says there is a guess, however little it leaves.",
        "Drive it through its range in small steps, as a triangle or a sine does.",
        amounts={"low": low, "high": high, "share": share},
    )

"""How far the output goes, and how wide its loop is."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.wording import amount, of_record, percent

NAME = "loop"


def find(evidence: Evidence) -> Iterator[Finding]:
    """Tell range and width of the loop, and which way round it is run."""
    for number, record in evidence.numbered():
        loops = evidence.loops(number)
        if not loops:
            continue
        largest = max(loops, key=lambda each: each.high - each.low)
        opening = np.mean([each.opening for each in loops if each.like(largest)], axis=0)
        span = float(np.ptp(record.y))
        widest = float(opening[np.argmax(np.abs(opening))])
        turned = "run counter-clockwise: the output lags" if widest >= 0.0 else "run clockwise"
        yield Finding(
            NAME,
            "remark",
            f"{of_record(evidence, number)}the output spans {amount(span, record.output_unit)}; "
            f"its loop is {percent(abs(widest) / span)} of that wide, {turned}.",
            record=number,
            amounts={"range": span, "width": widest, "share": abs(widest) / span},
        )

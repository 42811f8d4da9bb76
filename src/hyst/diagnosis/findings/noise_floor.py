"""The noise of the output, by what it does not repeat."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.wording import amount, of_record, percent

NAME = "noise"


def find(evidence: Evidence) -> Iterator[Finding]:
    """Tell the noise floor where drive and memory repeat; it is what a good model leaves."""
    for number, record in evidence.numbered():
        noise = evidence.noise(number)
        if noise is None:
            continue
        share = noise / float(np.ptp(record.y))
        yield Finding(
            NAME,
            "remark",
            f"{of_record(evidence, number)}the output repeats itself to "
            f"{amount(noise, record.output_unit)} rms ({percent(share)} of its range) where drive "
            "and memory are the same: what is smaller is no misfit of a model.",
            record=number,
            amounts={"noise": noise, "share": share},
        )

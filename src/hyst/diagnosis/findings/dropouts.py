"""Finding: dropouts of the output."""

from __future__ import annotations

from collections.abc import Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.values.measured import values_of_each
from hyst.diagnosis.values.wording import amount, indices, samples_counted, subject

NAME = "dropouts"


def find(evidence: Evidence) -> Iterable[Finding]:
    """Tell stretches of one value from which the output jumps back to its path."""
    for values in values_of_each(evidence):
        dropouts, unit = values.dropouts, values.record.output_unit
        if dropouts.samples.size == 0:
            continue
        few = values.dropouts_are_few
        jump = amount(dropouts.largest_jump, unit)
        yield Finding(
            NAME,
            "left out" if few else "refusal",
            f"{subject(evidence, values.number, 'output')} stands still for "
            f"{samples_counted(dropouts.samples.size)} ({indices(dropouts.samples)}) and then "
            f"jumps back to its path, by up to {jump}: nothing was measured there.",
            "" if few else "So many cannot be left out: mend the sensor or its connection.",
            values.number,
            dropouts.samples,
            {"count": float(dropouts.values.size), "largest": dropouts.largest_jump},
        )

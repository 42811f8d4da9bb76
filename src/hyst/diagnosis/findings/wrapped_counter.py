"""Finding: a counter that starts again at its other end."""

from __future__ import annotations

from collections.abc import Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.values.measured import values_of_each
from hyst.diagnosis.values.wording import amount, indices, subject

NAME = "wrapped counter"


def find(evidence: Evidence) -> Iterable[Finding]:
    """Tell signals that jump by one span, again and again, against the way they go."""
    for values in values_of_each(evidence):
        record = values.record
        for channel, wraps, unit in (
            ("input", values.input_wraps, record.input_unit),
            ("output", values.output_wraps, record.output_unit),
        ):
            if wraps is not None:
                yield Finding(
                    NAME,
                    "refusal",
                    f"{subject(evidence, values.number, channel)} jumps by about "
                    f"{amount(wraps.span, unit)} at {indices(wraps.samples)}, against the way it "
                    "goes: a counter starts again at its other end.",
                    "Put it together first, by numpy.unwrap with the counter's span as its period.",
                    values.number,
                    wraps.samples,
                    {"span": wraps.span},
                )

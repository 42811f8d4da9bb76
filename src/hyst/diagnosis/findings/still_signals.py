"""Finding: signals that do not move, or know two values only."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.values.measured import Values, values_of_each
from hyst.diagnosis.values.wording import amount, samples_counted, subject

NAME = "still signal"

# With fewer, an output of two values says nothing about what lies in between.
_FEWEST_INPUTS = 8


def find(evidence: Evidence) -> Iterable[Finding]:
    """Refuse a channel that stands on one value; tell an output of two as a switch."""
    for values in values_of_each(evidence):
        record = values.record
        for channel, signal, unit in (
            ("input", values.u, record.input_unit),
            ("output", values.y, record.output_unit),
        ):
            if signal.min() == signal.max():
                yield Finding(
                    NAME,
                    "refusal",
                    f"{subject(evidence, values.number, channel)} is constant: it is "
                    f"{amount(float(signal[0]), unit)} in all {samples_counted(signal.size)}.",
                    "Look whether it is the right column and whether the channel was connected.",
                    values.number,
                )
        yield from _switch(evidence, values)


def _switch(evidence: Evidence, values: Values) -> Iterable[Finding]:
    low, high = float(values.y.min()), float(values.y.max())
    if low == high or not np.all((values.y == low) | (values.y == high)):
        return
    if np.unique(values.u).size < _FEWEST_INPUTS:
        return
    unit = values.record.output_unit
    yield Finding(
        NAME,
        "warning",
        f"{subject(evidence, values.number, 'output')} takes two values only, {amount(low, unit)} "
        f"and {amount(high, unit)}: a switch, of which nothing but its thresholds can be told.",
        "If the actuator moves in between, look whether it is the right column.",
        values.number,
        amounts={"low": low, "high": high},
    )

"""Finding: outliers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.values.measured import Values, values_of_each
from hyst.diagnosis.values.spikes import Spikes
from hyst.diagnosis.values.wording import amount, indices, samples_counted, subject

NAME = "outliers"


def find(evidence: Evidence) -> Iterable[Finding]:
    """Tell single samples off the path of a signal; a few of the output are left out."""
    for values in values_of_each(evidence):
        if values.output_spikes.samples.size:
            yield _of_output(evidence, values)
        if values.input_spikes.samples.size:
            yield _of_input(evidence, values)


def _of_output(evidence: Evidence, values: Values) -> Finding:
    told = _told(evidence, values, "output", values.output_spikes, values.record.output_unit)
    few = values.spikes_are_few
    return Finding(
        NAME,
        "left out" if few else "warning",
        f"{told}.",
        "" if few else "So many are no accident: mend the sensor or its cable and measure again.",
        values.number,
        values.output_spikes.samples,
        _amounts(values.output_spikes),
    )


def _of_input(evidence: Evidence, values: Values) -> Finding:
    told = _told(evidence, values, "input", values.input_spikes, values.record.input_unit)
    return Finding(
        NAME,
        "warning",
        f"{told}; an actuator would remember such extremes, if they were there.",
        "If they were not, take the command as the input, or mend these samples.",
        values.number,
        values.input_spikes.samples,
        _amounts(values.input_spikes),
    )


def _told(evidence: Evidence, values: Values, channel: str, spikes: Spikes, unit: str) -> str:
    largest = amount(float(np.max(np.abs(spikes.departures))), unit)
    count = spikes.samples.size
    leaves = f"leaves its path for {samples_counted(count)} ({indices(spikes.samples)})"
    return f"{subject(evidence, values.number, channel)} {leaves}, by up to {largest}"


def _amounts(spikes: Spikes) -> dict[str, float]:
    return {
        "count": float(spikes.samples.size),
        "largest": float(np.max(np.abs(spikes.departures))),
    }

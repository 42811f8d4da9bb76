"""Finding: codes of instruments and loggers among the values."""

from __future__ import annotations

from collections.abc import Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding, Severity
from hyst.diagnosis.values.codes import Code
from hyst.diagnosis.values.measured import values_of_each
from hyst.diagnosis.values.wording import indices, samples_counted, subject

NAME = "code for no measurement"


def find(evidence: Evidence) -> Iterable[Finding]:
    """Tell values far outside all others.

    In the output a few are left out. In the input they refuse the record, for what the actuator
    remembers of the true input there is lost; so do more than 5 % of the output.
    """
    for values in values_of_each(evidence):
        few: Severity = "left out" if values.codes_are_few else "refusal"
        for code in values.output_codes:
            yield _finding(evidence, values.number, "output", code, few)
        for code in values.input_codes:
            yield _finding(evidence, values.number, "input", code, "refusal")


def _finding(
    evidence: Evidence, number: int, channel: str, code: Code, severity: Severity
) -> Finding:
    times = f"{code.times_the_range:,.0f}" if code.times_the_range < 1e6 else "over a million"
    meaning = f": {code.meaning}" if code.meaning else ""
    if severity == "left out":
        advice = "Find out why the instrument gave it."
    else:
        advice = "Cut the record there, or measure again."
    return Finding(
        NAME,
        severity,
        f"{subject(evidence, number, channel)} is {code.value:.7g} in "
        f"{samples_counted(code.samples.size)} ({indices(code.samples)}), {times} times the range "
        f"of all others away from them{meaning}.",
        advice,
        number,
        code.samples,
        {"value": code.value},
    )

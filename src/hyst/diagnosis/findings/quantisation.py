"""Finding: steps of the converters."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding, Severity
from hyst.diagnosis.values.measured import Values, values_of_each
from hyst.diagnosis.values.wording import amount, subject
from hyst.signals import hysteresis_percent, reversals, suggest_dead_band

NAME = "quantisation"

_COARSE = 1.0 / 50.0
_STEPS_OF_A_LOOP = 4.0
# Of a line as well, steps make a loop of one to two of them.
_ONE_STEP = 2.0
# With more values than this a loop of few steps is hardly any.
_FINE = 512
_ADVICE = (
    "Unless the actuator itself moves in such steps, use more of the converter's range, or one of "
    "more bits."
)


def find(evidence: Evidence) -> Iterable[Finding]:
    """Tell the steps of input and output; steps that hide the loop are a warning."""
    for values in values_of_each(evidence):
        found = _of_output(evidence, values), _of_input(evidence, values)
        yield from (each for each in found if each is not None)


def _of_output(evidence: Evidence, values: Values) -> Finding | None:
    levels = values.output_levels
    if levels is None:
        return None
    unit, spread = values.record.output_unit, float(np.ptp(values.y))
    opening = _opening(values) if levels.used <= _FINE else 0.0
    hides = _ONE_STEP <= opening / levels.step < _STEPS_OF_A_LOOP
    # An input of few values gives an output of few, whatever the converter.
    finer = np.unique(values.u).size > 2 * levels.used
    coarse = (finer and levels.step > _COARSE * spread) or hides
    told = f", and its loop opens by {amount(opening, unit)} at most" if hides else ""
    severity: Severity = "warning" if coarse else "remark"
    return Finding(
        NAME,
        severity,
        _sentence(evidence, values.number, "output", levels.used, levels.step, spread, unit)
        + told
        + ".",
        _ADVICE if coarse else "",
        values.number,
        amounts={"step": levels.step, "levels": float(levels.used)},
    )


def _opening(values: Values) -> float:
    """Give the opening of the loop, steps included; 0 where the input does not turn."""
    dead_band = suggest_dead_band(values.u)
    if reversals(values.u, dead_band).size == 0:
        return 0.0
    percent = hysteresis_percent(values.u, values.y, dead_band)
    return percent * float(np.ptp(values.y)) / 100.0


def _of_input(evidence: Evidence, values: Values) -> Finding | None:
    levels = values.input_levels
    if levels is None:
        return None
    unit, spread = values.record.input_unit, float(np.ptp(values.u))
    half = amount(levels.step / 2.0, unit)
    coarse = levels.step > _COARSE * spread
    return Finding(
        NAME,
        "remark",
        _sentence(evidence, values.number, "input", levels.used, levels.step, spread, unit) + ".",
        f"If it was measured and not commanded, radii are uncertain by {half}." if coarse else "",
        values.number,
        amounts={"step": levels.step, "levels": float(levels.used)},
    )


def _sentence(
    evidence: Evidence, number: int, channel: str, used: int, step: float, spread: float, unit: str
) -> str:
    share = f"{100.0 * step / spread:.2g} % of its range"
    begin = subject(evidence, number, channel)
    return f"{begin} comes in steps of {amount(step, unit)} ({share}), {used:,} values in all"

"""All findings, in the order in which they are told and looked for.

A finding is one file of ``hyst.diagnosis.findings`` with a function ``find`` and one line here.
Those that concern values which are no measurements come first, for the later ones pass those over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.findings import (
    butterfly,
    direction,
    disagreement,
    driven,
    drifting_output,
    dynamics,
    foreign_lines,
    gain_sign,
    loop_size,
    next_record,
    noise_floor,
    one_amplitude,
    rate_dependence,
    step_change,
)

Finder = Callable[[Evidence], Iterable[Finding]]

FINDERS: tuple[Finder, ...] = (
    step_change.find,
    drifting_output.find,
    butterfly.find,
    direction.find,
    foreign_lines.find,
    disagreement.find,
    rate_dependence.find,
    dynamics.find,
    one_amplitude.find,
    driven.find,
    loop_size.find,
    noise_floor.find,
    gain_sign.find,
    next_record.find,
)

"""All findings, in the order in which they are told and looked for.

A finding is one file of ``hyst.diagnosis.findings`` with a function ``find`` and one line here.
Those that concern values which are no measurements come first, for the later ones pass those over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.findings import delay_or_radius, output_ahead

Finder = Callable[[Evidence], Iterable[Finding]]

FINDERS: tuple[Finder, ...] = (
    output_ahead.find,
    delay_or_radius.find,
)

"""All findings, in the order in which they are told and looked for.

A finding is one file of ``hyst.diagnosis.findings`` with a function ``find`` and one line here.
Those that concern values which are no measurements come first, for the later ones pass those over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.findings import (
    codes,
    dropouts,
    outliers,
    output_is_noise,
    quantisation,
    saturated_sensor,
    still_signals,
    wrapped_counter,
)

Finder = Callable[[Evidence], Iterable[Finding]]

FINDERS: tuple[Finder, ...] = (
    codes.find,
    still_signals.find,
    wrapped_counter.find,
    dropouts.find,
    outliers.find,
    saturated_sensor.find,
    output_is_noise.find,
    quantisation.find,
)
